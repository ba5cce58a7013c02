#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/inputs.hpp"

// Lines in closed form, for tests.
namespace relative_map::core::test {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

/// From `start` straight on, a point each `spacing` [m], the last one at `length` [m] or less than one short.
inline Polyline straight(const Pose2& start, double length, double spacing) {
  Polyline points;
  const auto count = static_cast<std::size_t>(length / spacing + 1e-9);
  for (std::size_t i = 0; i <= count; ++i) {
    points.push_back(start.to_parent(Point2(spacing * static_cast<double>(i), 0.0)));
  }
  return points;
}

/// The pose at s [m] along the arc that leaves `start` with curvature `kappa` [1/m].
inline Pose2 along_arc(const Pose2& start, double kappa, double s) {
  const double turn = kappa * s;
  const Point2 position =
      kappa == 0.0 ? Point2(s, 0.0) : Point2(std::sin(turn) / kappa, (1.0 - std::cos(turn)) / kappa);
  return start.to_parent(Pose2(position, turn));
}

inline Polyline arc(const Pose2& start, double kappa, double length, double spacing) {
  Polyline points;
  const auto count = static_cast<std::size_t>(length / spacing + 1e-9);
  for (std::size_t i = 0; i <= count; ++i) {
    points.push_back(along_arc(start, kappa, spacing * static_cast<double>(i)).position());
  }
  return points;
}

/// A circle about the origin, counter-clockwise from (radius, 0): `count` points, evenly spread, none twice.
inline Polyline circle(double radius, std::size_t count) {
  Polyline points;
  for (std::size_t i = 0; i < count; ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / static_cast<double>(count);
    points.push_back(radius * Point2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

inline Polyline moved(const Polyline& points, const Pose2& parent_from_points) {
  Polyline result;
  for (const Point2& point : points) result.push_back(parent_from_points.to_parent(point));
  return result;
}

/// A path through `points`, with s and geometry.
inline PathPoints path_through(const Polyline& points) {
  PathPoints path(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) path[i].position = points[i];
  compute_arc_length(path);
  compute_geometry(path);
  return path;
}

/// A recording of nothing but positions.
inline RecordedLine recording(const Polyline& points, const std::string& name = "line",
                              std::uint32_t priority = 0) {
  RecordedLine line;
  line.name = name;
  line.priority = priority;
  for (const Point2& point : points) {
    line.points.push_back({point.x(), point.y(), kNaN, kNaN, kNaN, kNaN, kNaN});
  }
  return line;
}

/// Distance to the nearest point of a polyline, by looking at every segment.
inline Foot nearest_by_brute_force(const Polyline& points, const Point2& point) {
  Foot best;
  best.squared_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < points.size(); ++i) {
    Foot foot = project_on_segment(points[i], points[i + 1], point);
    foot.segment = i;
    if (foot.squared_distance < best.squared_distance) best = foot;
  }
  return best;
}

inline double distance_by_brute_force(const Polyline& points, const Point2& point) {
  return std::sqrt(nearest_by_brute_force(points, point).squared_distance);
}

}  // namespace relative_map::core::test
