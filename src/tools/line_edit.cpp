#include "relative_map/tools/line_edit.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace relative_map::core {

namespace {

constexpr double kMinLapLength = 30.0;    // [m]
constexpr double kMaxTurn = 0.8;          // [rad] between ends that are to meet
constexpr double kDirectionLength = 3.0;  // [m] of line that a direction at an end is taken from
constexpr double kSeamLength = 50.0;      // [m] that an error at the seam is spread over

std::string metres(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value << " m";
  return text.str();
}

/// The line with its geometry; a closed one with its start once more at the end.
PathPoints whole_path(const EditableLine& line) {
  PathPoints path = path_of(line);
  if (line.closed()) {
    path.push_back(path.front());
    path.back().s = length_of(line);
  }
  return path;
}

/// Points of a line by s, each O(1) if they are asked for in order.
class Sampler {
 public:
  explicit Sampler(const EditableLine& line) : path_(whole_path(line)), heights_(line.z) {
    if (line.closed()) heights_.push_back(heights_.front());
  }
  double length() const { return path_.back().s; }
  double kappa(double s) { return interpolate(path_, s, hint_).kappa; }
  void add_to(EditableLine& line, double s) {
    const PathPoint point = interpolate_smoothly(path_, s, hint_);
    line.points.push_back(point.position);
    const std::size_t next = std::min(hint_ + 1, path_.size() - 1);
    const double step = path_[next].s - path_[hint_].s;
    const double weight = step > 0.0 ? (point.s - path_[hint_].s) / step : 0.0;
    line.z.push_back(weight > 0.0 ? heights_[hint_] + weight * (heights_[next] - heights_[hint_])
                                  : heights_[hint_]);
  }
  const PathPoints& path() const { return path_; }

 private:
  PathPoints path_;
  std::vector<double> heights_;
  std::size_t hint_ = 0;
};

EditableLine without_points(const EditableLine& line) {
  EditableLine result = line;
  result.points.clear();
  result.z.clear();
  return result;
}

double signed_angle(const Point2& a, const Point2& b) {
  return std::atan2(cross(a, b), a.dot(b));
}

/// Unit direction at the first, or the last, point: as the metres from there lead, and bend.
Point2 direction_at_start(const Polyline& points) {
  const auto farther = [&](std::size_t i, const Point2& from) {
    while (i + 1 < points.size() && (points[i] - from).norm() < kDirectionLength) ++i;
    return i;
  };
  const std::size_t middle = farther(1, points[0]);
  const Point2 chord = points[middle] - points[0];
  if (middle + 1 >= points.size()) return chord.normalized();
  const Point2 next = points[farther(middle + 1, points[middle])] - points[middle];
  return Pose2({}, -0.5 * signed_angle(chord, next)).rotate_to_parent(chord).normalized();
}
Point2 direction_at_end(const Polyline& points) {
  Polyline back(points.rbegin(), points.rend());
  return -direction_at_start(back);
}

double angle_between(const Point2& a, const Point2& b) {
  return std::abs(signed_angle(a, b));
}

/// How many points there are before the line passes its start again; all of them if it does not.
std::size_t points_of_lap(const PathPoints& path, const Polyline& points, double max_gap) {
  const Point2 forward = direction_at_start(points);
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (path[i].s < kMinLapLength) continue;
    const Point2 before = path[i].position - path[0].position,
                 after = path[i + 1].position - path[0].position;
    const bool passes = forward.dot(before) < 0.0 && forward.dot(after) >= 0.0;
    const bool beside = std::abs(cross(forward, before)) <= max_gap &&
                        before.norm() <= 2.0 * max_gap + (after - before).norm();
    if (passes && beside && angle_between(forward, after - before) <= kMaxTurn) return i + 1;
  }
  return path.size();
}

/// Moves the end sideways to meet the start, less and less towards where it began.
void blend_seam(EditableLine& line) {
  const PathPoints path = path_of(line);
  // The chord over a gap in a curve leads half-way between the directions at its ends.
  const Point2 along = (direction_at_end(line.points) + direction_at_start(line.points)).normalized();
  const double error = cross(along, line.points.front() - line.points.back());
  const double blend = std::min(kSeamLength, path.back().s / 4.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double u = 1.0 - (path.back().s - path[i].s) / blend;
    if (u > 0.0)
      line.points[i] += error * u * u * u * (10.0 + u * (6.0 * u - 15.0)) * left_of(path[i].direction);
  }
}

void bridge_gap(EditableLine& line, double spacing) {
  const double gap = (line.points.front() - line.points.back()).norm();
  const auto steps = static_cast<int>(std::round(gap / spacing));
  const Point2 from = line.points.back(), to = line.points.front();
  const Point2 leaving = gap * direction_at_end(line.points),
               arriving = gap * direction_at_start(line.points);
  for (int i = 1; i < steps; ++i) {
    const double t = static_cast<double>(i) / steps, u = 1.0 - t;  // Hermite's cubic
    line.points.push_back(u * u * (1.0 + 2.0 * t) * from + t * t * (1.0 + 2.0 * u) * to +
                          t * u * u * leaving - t * t * u * arriving);
    line.z.push_back(u * line.z.back() + t * line.z.front());
  }
}

}  // namespace

EditableLine resample(const EditableLine& line, double spacing) {
  Sampler sampler(line);
  EditableLine result = without_points(line);
  const auto steps = static_cast<std::size_t>(std::max(1.0, std::round(sampler.length() / spacing)));
  for (std::size_t i = 0; i < steps + (line.closed() ? 0 : 1); ++i) {
    sampler.add_to(result, sampler.length() * static_cast<double>(i) / static_cast<double>(steps));
  }
  return result;
}

std::vector<CurvatureSpacing> default_curvature_spacing() {
  return {{0.0, 3.0}, {0.002, 1.0}, {0.008, 0.4}, {0.02, 0.1}};
}

EditableLine resample_by_curvature(const EditableLine& line, const std::vector<CurvatureSpacing>& steps) {
  Sampler sampler(line);
  EditableLine result = without_points(line);
  const double finest = steps.back().spacing;
  double s = 0.0;
  while (s < sampler.length() - 0.5 * finest) {
    sampler.add_to(result, s);
    double step = finest;
    for (const CurvatureSpacing& candidate : steps) {
      // All the way there: a step must not leap into a curve.
      double greatest = 0.0;
      for (double ahead = 0.0; ahead <= candidate.spacing; ahead += finest) {
        greatest = std::max(greatest, std::abs(sampler.kappa(s + ahead)));
      }
      const auto next = &candidate + 1;
      if (next == steps.data() + steps.size() || greatest <= next->above_curvature) {
        step = candidate.spacing;
        break;
      }
    }
    s += step;
  }
  if (!line.closed()) sampler.add_to(result, sampler.length());
  return result;
}

EditableLine close(const EditableLine& line, double max_gap) {
  EditableLine result = line;
  result.repeats_start = true;
  if (line.closed()) return result;
  const PathPoints path = path_of(line);
  if (path.back().s < kMinLapLength) {
    throw std::runtime_error("the line is " + metres(path.back().s) + " long, too short for a lap");
  }
  const std::size_t end = points_of_lap(path, line.points, max_gap);
  result.points.resize(end);
  result.z.resize(end);
  const Point2 forward = direction_at_start(result.points);
  const Point2 gap = result.points.front() - result.points.back();
  const double turn = angle_between(direction_at_end(result.points), forward);
  if (gap.norm() > 2.0 * max_gap || std::abs(forward.dot(gap)) > max_gap) {
    throw std::runtime_error("the ends are " + metres(gap.norm()) + " apart, more than the gap of " +
                             metres(max_gap) +
                             " that may be bridged, and the line does not pass its start again");
  }
  if (turn > kMaxTurn) throw std::runtime_error("the ends point into different directions");
  const double spacing = path[end - 1].s / static_cast<double>(end - 1);
  while (result.points.size() > 4 &&
         forward.dot(result.points.front() - result.points.back()) < 0.5 * spacing) {
    result.points.pop_back();
    result.z.pop_back();
  }
  blend_seam(result);
  bridge_gap(result, spacing);
  result.ends = Ends::kClosed;
  return result;
}

EditableLine reverse(const EditableLine& line) {
  EditableLine result = line;
  std::reverse(result.points.begin(), result.points.end());
  std::reverse(result.z.begin(), result.z.end());
  return result;
}

EditableLine cut(const EditableLine& line, double from, double to) {
  Sampler sampler(line);
  const double length = sampler.length();
  if (!(from >= 0.0 && from <= length && to >= 0.0 && to <= length + 1e-6)) {
    throw std::runtime_error("the line goes from s = 0 to " + metres(length) + ", which does not hold " +
                             metres(from) + " to " + metres(to));
  }
  if (from >= to && !line.closed())
    throw std::runtime_error("the cut ends before it starts, and the line is no loop");
  EditableLine result = without_points(line);
  result.ends = Ends::kOpen;
  result.repeats_start = false;
  const auto copy = [&](double begin, double end) {
    for (std::size_t i = 0; i < line.points.size(); ++i) {
      const double s = sampler.path()[i].s;
      if (s <= begin + 1e-3 || s >= end - 1e-3) continue;
      result.points.push_back(line.points[i]);
      result.z.push_back(line.z[i]);
    }
  };
  sampler.add_to(result, from);
  if (from < to) {
    copy(from, to);
  } else {
    copy(from, length);
    copy(-1.0, to);
  }
  sampler.add_to(result, to);
  if (chord_length(result.points) < 1e-3) throw std::runtime_error("nothing is left of the line");
  return result;
}

EditableLine join(const std::vector<EditableLine>& lines, double max_gap) {
  EditableLine result = lines.at(0);
  for (std::size_t k = 0; k < lines.size(); ++k) {
    if (lines[k].closed())
      throw std::runtime_error("line " + std::to_string(k) + " is a loop, which has no ends to join");
    if (k == 0) continue;
    const Point2 end = result.points.back(), forward = direction_at_end(result.points);
    const Point2 shift = lines[k].origin - result.origin;
    Polyline points;
    for (const Point2& point : lines[k].points) points.push_back(point + shift);
    std::size_t first = 0;  // that is past the end of what there is
    while (first < points.size() && forward.dot(points[first] - end) < 1e-3 &&
           (first == 0 || std::abs(cross(forward, points[first] - end)) <= max_gap)) {
      ++first;
    }
    const bool meets =
        first < points.size() && (points[first] - end).norm() <= max_gap + (first > 0 ? 5.0 : 0.0);
    if (!meets) {
      throw std::runtime_error(
          "line " + std::to_string(k) + " starts " + metres((points[0] - end).norm()) +
          " from the end of the one before, or runs the other way: more than the gap of " + metres(max_gap) +
          " that may be bridged");
    }
    const Polyline rest(points.begin() + static_cast<std::ptrdiff_t>(first), points.end());
    if (rest.size() > 1 && angle_between(forward, direction_at_start(rest)) > kMaxTurn) {
      throw std::runtime_error("line " + std::to_string(k) +
                               " goes on in another direction than the one before it");
    }
    result.points.insert(result.points.end(), rest.begin(), rest.end());
    result.z.insert(result.z.end(), lines[k].z.begin() + static_cast<std::ptrdiff_t>(first),
                    lines[k].z.end());
  }
  return result;
}

}  // namespace relative_map::core
