#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <stdexcept>

#include "line_ends.hpp"
#include "relative_map/tools/line_edit.hpp"

namespace relative_map::core {

namespace {

constexpr double kMinLapLength = 30.0;  // [m]
constexpr double kSeamLength = 50.0;    // [m] that an error at the seam is spread over

std::string metres(double value) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(2) << value << " m";
  return text.str();
}

/// From half of `length` [m] before a point to as far after it.
Point2 chord_around(const Polyline& points, std::size_t i, double length) {
  std::size_t before = i, after = i;
  while (before > 0 && (points[before] - points[i]).norm() < 0.5 * length) --before;
  while (after + 1 < points.size() && (points[after] - points[i]).norm() < 0.5 * length) ++after;
  return points[after] - points[before];
}

/// How many points there are before the line passes its start again; all of them if it does not.
std::size_t points_of_lap(const PathPoints& path, const Polyline& points, double max_gap) {
  const Point2 forward = direction_at_start(points);
  const double length = direction_length(points);
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    if (path[i].s < kMinLapLength) continue;
    const Point2 before = path[i].position - path[0].position,
                 after = path[i + 1].position - path[0].position;
    const bool passes = forward.dot(before) < 0.0 && forward.dot(after) >= 0.0;
    const bool beside = std::abs(cross(forward, before)) <= max_gap &&
                        before.norm() <= 2.0 * max_gap + (after - before).norm();
    if (passes && beside && angle_between(forward, chord_around(points, i, length)) <= kMaxTurn) return i + 1;
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

}  // namespace relative_map::core
