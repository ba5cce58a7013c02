#include "own_border.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace relative_map::core {

namespace {

constexpr double kSharpestFold = 0.8;  // of the radius: a border farther inside a curve would fold
constexpr double kRoomStep = 0.5;      // [m] between the places of a lane where its room is looked at
constexpr double kNoLimit = std::numeric_limits<double>::infinity();

/// [1/m] over a stretch of `reach` [m] to both sides: a noisy line has sharp bends at single vertices.
double mean_curvature(const PathPoints& points, std::size_t i, double reach) {
  std::size_t first = i, last = i;
  while (first > 0 && points[i].s - points[first].s < reach) --first;
  while (last + 1 < points.size() && points[last].s - points[i].s < reach) ++last;
  return angle_difference(points[last].theta, points[first].theta) / (points[last].s - points[first].s);
}

/// [m] along the unit vector `normal`, from the origin, to where it is as near to `point` as to the origin.
double way_to_middle(const Point2& normal, const Point2& point) {
  const double along = normal.dot(point);
  return along > 0.0 ? point.squaredNorm() / (2.0 * along) : kNoLimit;
}

/// Likewise to a segment from a to b: the radius of the circle that touches both it and, in the origin, the
/// line square to `normal`.
double way_to_middle(const Point2& normal, const Point2& a, const Point2& b) {
  Point2 to_segment = left_of((b - a).normalized());
  if (to_segment.dot(a) < 0.0) to_segment = -to_segment;
  const double radius =
      to_segment.dot(a) / (1.0 + to_segment.dot(normal));  // negative never, NaN where both are 0
  const double ends = std::min(way_to_middle(normal, a), way_to_middle(normal, b));
  const double place = (radius * (normal + to_segment) - a).dot(b - a);
  const bool touches = place > 0.0 && place < (b - a).squaredNorm();
  return touches ? std::min(ends, radius) : ends;
}

/// [m] along the unit vector `normal`, from `vertex`, to where it is as near to a polyline as to the vertex;
/// `most`, if it is farther.
double way_to_middle(const Point2& vertex, const Point2& normal, const PathPoints& other, double most) {
  double way = most;
  for (std::size_t i = 0; i + 1 < other.size();) {
    const Point2 end = other[i + 1].position - vertex;
    way = std::min(way, way_to_middle(normal, other[i].position - vertex, end));
    // What is farther away than twice the way does not matter, and nothing comes nearer by more than its
    // length.
    const double far_to = other[i + 1].s + end.norm() - 2.0 * way;
    for (++i; i + 1 < other.size() && other[i + 1].s <= far_to;) ++i;
  }
  return way;
}

/// Each width so that the border, which is straight from vertex to vertex, keeps to the middle in between
/// too.
void limit_to_room(const PathPoints& points, const PathPoints& other, Side side,
                   std::vector<double>& widths) {
  const double sign = static_cast<double>(side);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint& from = points[i];
    widths[i] = way_to_middle(from.position, sign * left_of(from.direction), other, widths[i]);
    if (i + 1 == points.size()) break;
    const PathPoint& to = points[i + 1];
    const int steps = static_cast<int>(std::ceil((to.s - from.s) / kRoomStep));
    for (int step = 1; step < steps; ++step) {
      const double share = static_cast<double>(step) / steps;
      const Point2 normal =
          sign * left_of((from.direction + share * (to.direction - from.direction)).normalized());
      const double room = way_to_middle(from.position + share * (to.position - from.position), normal, other,
                                        std::max(widths[i], widths[i + 1]));
      widths[i] = std::min(widths[i], room);
      widths[i + 1] = std::min(widths[i + 1], room);
    }
  }
}

}  // namespace

Point2 border_point(const PathPoints& points, std::size_t i, double half_width, Side side) {
  const double sign = static_cast<double>(side);
  if (points[i].kappa * sign * half_width > kSharpestFold) {  // the curve turns to this side, or it is noise
    const double inward = mean_curvature(points, i, half_width) * sign;
    if (inward * half_width > kSharpestFold) half_width = kSharpestFold / inward;
  }
  return points[i].position + sign * half_width * left_of(points[i].direction);
}

Polyline own_border(const LanePath& lane, const LanePath* other, double half_width, Side side) {
  std::vector<double> widths(lane.points.size(), half_width);
  if (other) limit_to_room(lane.points, other->points, side, widths);
  Polyline border;
  border.reserve(lane.points.size());
  for (std::size_t i = 0; i < lane.points.size(); ++i)
    border.push_back(border_point(lane.points, i, widths[i], side));
  return border;
}

}  // namespace relative_map::core
