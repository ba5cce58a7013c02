#include "relative_map/pipeline/lines/closed_line.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kMinLapLength = 30.0;  // [m] no vehicle drives a tighter circle
constexpr double kMaxStitchTurn = 0.5;  // [rad] between the headings of the ends of a lap
constexpr double kMaxSparseGap = 5.0;   // [m] along a sparsely sampled lap, from its last vertex to its first
constexpr double kSeamBlendLength = 30.0;  // [m] over which a lap's closing error is spread

Polyline positions(const PathPoints& points, std::size_t begin, std::size_t end) {
  Polyline result;
  for (std::size_t i = begin; i < end; ++i) result.push_back(points[i].position);
  return result;
}

/// Whether all points from `begin` on lie on the line before them, and lead the same way.
bool repeats_itself(const PathPoints& points, std::size_t begin, double half_width) {
  const Polyline lap = positions(points, 0, begin);
  PolylineWalker walker(lap);
  return std::all_of(
      points.begin() + static_cast<std::ptrdiff_t>(begin), points.end(), [&](const PathPoint& point) {
        const Foot foot = walker.next(point.position);
        const Point2 along = lap[foot.segment + 1] - lap[foot.segment];
        return foot.squared_distance <= half_width * half_width && along.dot(point.direction) > 0.0;
      });
}

/// How many points a line has up to where it reaches its start again, to repeat itself from there on.
/// All of them if it does not, or if it goes elsewhere from there.
std::size_t points_of_lap(const PathPoints& points, double half_width) {
  const PathPoint& first = points.front();
  bool next_is_past_start = false;
  for (std::size_t end = points.size(); points[end - 1].s > kMinLapLength; --end) {
    const PathPoint& point = points[end - 1];
    const Point2 offset = point.position - first.position;
    const bool beside_start = std::abs(cross(first.direction, offset)) <= half_width &&
                              std::abs(angle_difference(point.theta, first.theta)) <= kMaxStitchTurn;
    const bool past_start = first.direction.dot(offset) >= 0.0;
    if (next_is_past_start && beside_start && !past_start) {
      return repeats_itself(points, end, half_width) ? end : points.size();
    }
    next_is_past_start = beside_start && past_start;
  }
  return points.size();
}

/// How many of the first `end` points are left without those that come too near to the start, so that the
/// stitch goes forward.
std::size_t without_overlap(const PathPoints& points, std::size_t end, double spacing) {
  const PathPoint& first = points.front();
  while (end > 0 && (first.position - points[end - 1].position).dot(first.direction) < 0.3 * spacing) --end;
  return end;
}

/// Spreads the sideways error at the seam over the end of the lap.
void blend_seam(PathPoints& points, double length) {
  const Point2 stitch = points.front().position - points.back().position;
  const Point2 along = (points.front().direction + points.back().direction).normalized();
  const double error = cross(along, stitch);
  if (std::abs(error) < 0.01) return;
  const double blend = std::min(kSeamBlendLength, length / 4.0);
  for (PathPoint& point : points) {
    const double u = 1.0 - (points.back().s - point.s) / blend;
    if (u > 0.0) {
      const double smooth = u * u * u * (10.0 + u * (6.0 * u - 15.0));
      point.position += error * smooth * left_of(point.direction);
    }
  }
}

}  // namespace

bool stitch(NavigationLine& line, double half_width) {
  PathPoints& points = line.points;
  if (points.size() < 4 || line.length < kMinLapLength) return false;
  const double spacing = line.length / static_cast<double>(points.size() - 1);
  const std::size_t end = points_of_lap(points, half_width);
  const PathPoint &first = points.front(), &last = points[end - 1];
  const double turn = angle_difference(last.theta, first.theta);
  const Point2 along = (first.direction + last.direction).normalized();
  const Point2 gap = first.position - last.position;
  const double gap_ahead = std::max(half_width, std::min(1.5 * spacing, kMaxSparseGap));
  const bool ends_meet = std::abs(cross(along, gap)) <= half_width && gap.dot(along) <= gap_ahead &&
                         gap.dot(along) >= -half_width;
  if (!ends_meet || std::abs(turn) > kMaxStitchTurn) return false;
  const std::size_t lap_end = without_overlap(points, end, spacing);
  if (lap_end < 4) return false;  // there and back, it goes round nothing

  points.resize(lap_end);
  blend_seam(points, points.back().s);
  compute_arc_length(points);
  line.ends = Ends::kClosed;
  line.length = points.back().s + (points.front().position - points.back().position).norm();
  compute_geometry(points, Ends::kClosed, line.length);
  return true;
}

}  // namespace relative_map::core
