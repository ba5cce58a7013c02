#include "relative_map/tools/line_edit.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "line_ends.hpp"

namespace relative_map::core {

namespace {

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
