#include "relative_map/tools/line_smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>

#include "smoothing_round.hpp"

namespace relative_map::core {

namespace {

constexpr double kReferenceLength = 2.0;  // [m] to leave out noise, and keep a corner of 5 m radius to 2 cm
constexpr int kMaxRounds = 7;
constexpr double kSettled = 0.01;        // [m] the reference has moved no farther
constexpr double kTolerance = 1e-4;      // [m] of the bound
constexpr double kLongestSegment = 5.0;  // [m] a recording with longer ones says nothing between its points
constexpr std::size_t kLookAround = 12;  // segments of the recording
constexpr double kAstray = 20.0;         // times the bound
constexpr double kRoomy = 0.9;           // of the bound
constexpr double kFollowInNoise = 5.0;   // [m] that keeps curves from being cut where the bound is wide
// Of the bound, softest first: so soft, it gives way before the line gets kinks. Where that is too much, it
// is made to hold, as long as the vehicle can follow.
constexpr std::array<double, 3> kStiffnesses = {1e-2, 1.0, 1e2};

/// Evenly spaced points along a polyline, about `spacing` [m] apart; the ends of an open one are kept.
Polyline resampled(const EditableLine& line, const Polyline& points, double spacing, bool smoothly) {
  EditableLine shape;
  shape.points = points;
  shape.ends = line.ends;
  PathPoints path = path_of(shape);
  if (line.closed()) {
    path.push_back(path.front());
    path.back().s = length_of(shape);
  }
  const double length = path.back().s;
  const auto steps =
      static_cast<std::size_t>(std::max(line.closed() ? 8.0 : 4.0, std::round(length / spacing)));
  Polyline result;
  std::size_t hint = 0;
  for (std::size_t i = 0; i < steps + (line.closed() ? 0 : 1); ++i) {
    const double s = length * static_cast<double>(i) / static_cast<double>(steps);
    result.push_back((smoothly ? interpolate_smoothly(path, s, hint) : interpolate(path, s, hint)).position);
  }
  return result;
}

struct Deviation {
  double distance = 0.0;
  std::size_t point = 0;  ///< of the result
};

Polyline with_closing(const Polyline& points, Ends ends) {
  Polyline result = points;
  if (ends == Ends::kClosed) result.push_back(points.front());
  return result;
}

/// Between which of the recorded points nothing was recorded, and where on the result that begins.
void find_gap(const EditableLine& recorded, const PathPoints& path, SmoothedLine& result) {
  std::size_t start = 0;
  const Polyline raw = with_closing(recorded.points, recorded.ends);
  for (std::size_t i = 0; i + 1 < raw.size(); ++i) {
    const double gap = (raw[i + 1] - raw[i]).norm();
    if (gap <= result.longest_gap) continue;
    result.longest_gap = gap;
    start = i;
  }
  double nearest = std::numeric_limits<double>::infinity();
  for (const PathPoint& point : path) {
    const double distance = (point.position - raw[start]).squaredNorm();
    if (distance >= nearest) continue;
    nearest = distance;
    result.gap_s = point.s;
  }
}

/// The farthest that recording and result lie apart.
Deviation deviation_of(const EditableLine& recorded, const Polyline& points) {
  const Polyline raw = with_closing(recorded.points, recorded.ends),
                 result = with_closing(points, recorded.ends);
  Deviation worst;
  const auto note = [&](double squared_distance, std::size_t point) {
    const double distance = std::sqrt(squared_distance);
    if (distance > worst.distance) worst = {distance, std::min(point, points.size() - 1)};
  };
  PolylineWalker along_result(result);
  std::vector<std::size_t> beside(points.size(),
                                  0);  // of each point of the result: a segment of the recording
  for (std::size_t i = 0; i < raw.size(); ++i) {
    const Foot foot = along_result.next(raw[i]);
    note(foot.squared_distance, foot.segment);
    beside[std::min(foot.segment, points.size() - 1)] = std::min(i, raw.size() - 2);
  }
  // Noise makes a recording go to and fro, so that a walk along it would get lost.
  for (std::size_t i = 0, near = 0; i < points.size(); ++i) {
    near = std::max(near, beside[i]);
    Foot nearest;
    nearest.squared_distance = std::numeric_limits<double>::infinity();
    for (std::size_t k = near - std::min(near, kLookAround);
         k <= std::min(raw.size() - 2, near + kLookAround); ++k) {
      Foot foot = project_on_segment(raw[k], raw[k + 1], points[i]);
      foot.segment = k;
      if (foot.squared_distance < nearest.squared_distance) nearest = foot;
    }
    const bool known = (raw[nearest.segment + 1] - raw[nearest.segment]).norm() <= kLongestSegment;
    if (known) note(nearest.squared_distance, i);
  }
  return worst;
}

std::vector<double> heights_of(const EditableLine& recorded, const Polyline& points) {
  const Polyline raw = with_closing(recorded.points, recorded.ends);
  std::vector<double> heights = recorded.z, result;
  if (recorded.closed()) heights.push_back(heights.front());
  PolylineWalker walker(raw);
  for (const Point2& point : points) {
    const Foot foot = walker.next(point);
    result.push_back(heights[foot.segment] +
                     foot.fraction * (heights[foot.segment + 1] - heights[foot.segment]));
  }
  return result;
}

std::string place(double s) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "at s = " << s << " m";
  return text.str();
}

void measure(const EditableLine& recorded, const Deviation& deviation, const SmootherParam& param,
             SmoothedLine& result) {
  const PathPoints path = path_of(result.line);
  find_gap(recorded, path, result);
  result.length = length_of(result.line);
  result.greatest_deviation = deviation.distance;
  result.deviation_s = path[deviation.point].s;
  for (const PathPoint& point : path) {
    if (std::abs(point.kappa) > result.greatest_kappa) {
      result.greatest_kappa = std::abs(point.kappa);
      result.kappa_s = point.s;
    }
    if (std::abs(point.dkappa) > result.greatest_dkappa) {
      result.greatest_dkappa = std::abs(point.dkappa);
      result.dkappa_s = point.s;
    }
  }
  std::ostringstream fault;
  fault << std::fixed << std::setprecision(2);
  if (result.greatest_deviation > param.bound + kTolerance) {
    fault << "the bound of " << param.bound << " m cannot be held " << place(result.deviation_s)
          << ": a line that the vehicle can drive lies " << result.greatest_deviation
          << " m beside the recording there";
  } else if (result.greatest_kappa > param.max_curvature) {
    fault << "the bound of " << param.bound << " m cannot be held " << place(result.kappa_s)
          << ": within it, the line would have to bend by " << result.greatest_kappa
          << " 1/m, and the vehicle can bend by " << param.max_curvature << " 1/m";
  }
  result.fault = fault.str();
}

/// Where the points lie too wildly for any line to be found.
std::string wild_fault(const Deviation& deviation, double spacing, double bound) {
  std::ostringstream fault;
  fault << std::fixed << std::setprecision(2) << "the bound of " << bound << " m cannot be held "
        << place(spacing * static_cast<double>(deviation.point)) << ": the recorded points lie "
        << deviation.distance << " m beside a smooth line there";
  return fault.str();
}

/// Rounds about ever better references, at one stiffness of the bound. False if the numbers fail.
bool run_rounds(const EditableLine& recorded, const SmootherParam& param, double stiffness,
                Polyline reference, const std::function<void()>& iterated, SmoothedLine& result) {
  double bound = param.bound - kTolerance;
  Deviation deviation;
  for (int round = 0; round < kMaxRounds; ++round) {
    reference = resampled(recorded, reference, param.spacing, true);
    double moved = 0.0;
    Polyline points = smoothing_round(recorded, reference, {bound, param.follow, stiffness}, iterated, moved);
    if (points.empty()) return false;
    reference = std::move(points);
    // Kinks send the lines through them astray: this stiffness is too much for the recording.
    if (moved > kAstray * param.bound && round > 0) return false;
    deviation = deviation_of(recorded, reference);
    // The first reference is rough, and what lies beside it not quite so beside the result.
    const double room = param.bound - deviation.distance;
    if (room >= 0.0 && moved < kSettled && round > 0) break;
    if (round > 0) bound = std::clamp(bound + room - kTolerance, 0.5 * param.bound, param.bound - kTolerance);
  }
  result.line.points = std::move(reference);
  result.line.z = heights_of(recorded, result.line.points);
  measure(recorded, deviation, param, result);
  return true;
}

}  // namespace

SmoothedLine smooth_line(const EditableLine& recorded, const SmootherParam& param,
                         const std::function<void(double)>& progress) {
  SmoothedLine smoothest;
  smoothest.line = recorded;
  // Noise grows with the bound that it asks for.
  const double reference_length = kReferenceLength * std::cbrt(std::max(1.0, param.bound / 0.25));
  Polyline reference = resampled(recorded, recorded.points, param.spacing, false);
  const double spacing = chord_length(reference) / static_cast<double>(reference.size() - 1);
  reference = low_pass(reference, recorded.ends, reference_length, spacing);

  double done = 0.0;
  const auto iterated = [&] { progress(done += 0.02 * (1.0 - done)); };
  smoothest.fault = wild_fault(deviation_of(recorded, reference), spacing, param.bound);
  bool first = true;
  for (const double stiffness : kStiffnesses) {
    SmoothedLine result = smoothest;
    if (!run_rounds(recorded, param, stiffness, reference, iterated, result)) break;
    if (first || result.fault.empty()) smoothest = result;
    first = false;
    if (result.fault.empty()) break;
  }
  progress(1.0);
  return smoothest;
}

std::optional<SmootherParam> find_feasible(const EditableLine& recorded, const SmootherParam& param,
                                           double max_bound, const std::function<void(double)>& progress) {
  std::optional<SmootherParam> feasible;
  SmootherParam tried = param;
  tried.follow = kFollowInNoise;
  for (double bound = param.bound; bound < max_bound; bound *= 2.0) {
    tried.bound = std::min(2.0 * bound, max_bound);
    const SmoothedLine wide = smooth_line(recorded, tried, progress);
    if (!wide.fault.empty()) continue;
    feasible = tried;
    // A bound that binds makes the line rough.
    if (wide.greatest_deviation > kRoomy * tried.bound) continue;
    tried.bound = std::ceil(20.0 * wide.greatest_deviation + 1.0) / 20.0;
    return smooth_line(recorded, tried, progress).fault.empty() ? tried : feasible;
  }
  return feasible;
}

}  // namespace relative_map::core
