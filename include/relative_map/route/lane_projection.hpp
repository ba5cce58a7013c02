#pragma once

#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/segment_index.hpp"

namespace relative_map::core {

/// Where a point lies beside a lane.
struct LaneProjection {
  double s = 0.0;         ///< [m] along the centerline; negative before it, more than its length past it
  double l = 0.0;         ///< [m] left of it; past the ends: left of the tangent there
  double distance = 0.0;  ///< [m] to the nearest point of the centerline
  double heading = 0.0;   ///< [rad] of the chord that it was projected on
};

/// A lane's centerline, prepared to be projected on: in logarithmic time, past both ends, on lanes of one
/// chord as on long ones.
class LaneLine {
 public:
  LaneLine() = default;
  /// Points nearer than 0.1 um to the one before are left out; two must remain, all finite.
  explicit LaneLine(const Polyline& centerline);

  const PathPoints& points() const { return points_; }
  double length() const { return points_.back().s; }

  /// The nearest place on the lane; of several equally near ones the first.
  LaneProjection project(const Point2& point) const;
  /// Every place where the lane passes by within `max_distance` [m]: a lane may do so more than once.
  std::vector<LaneProjection> passes(const Point2& point, double max_distance) const;

  /// The point at s [m], held at the ends.
  Point2 point_at(double s) const;
  /// The direction of the chord at s [m], held at the ends.
  double heading_at(double s) const;

 private:
  LaneProjection from_foot(const Foot& foot, const Point2& point) const;
  std::size_t chord_at(double s) const;

  PathPoints points_;
  SegmentIndex index_;
};

}  // namespace relative_map::core
