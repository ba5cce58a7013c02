#pragma once

#include <string>

#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "support/lines.hpp"

// Lanes in the body frame, between the stages.
namespace relative_map::core::test {

inline LanePath lane(const std::string& id, const Polyline& points, std::uint32_t priority = 0) {
  LanePath lane;
  lane.id = lane.name = id;
  lane.priority = priority;
  lane.points = path_through(points);
  lane.left_half_width = lane.right_half_width = 1.75;
  locate_vehicle(lane);
  lane.remaining = lane.points.back().s - lane.s_at_vehicle;
  return lane;
}

/// A straight lane ahead, `y` [m] to the left, from x = `from` to `to`.
inline LanePath straight_lane(const std::string& id, double y, std::uint32_t priority = 0, double from = -2.0,
                              double to = 100.0, double spacing = 0.5) {
  return lane(id, straight(Pose2(Point2(from, y), 0.0), to - from, spacing), priority);
}

/// The lane at `offset` [m] to the left of a circle of curvature `kappa` [1/m] through the vehicle.
inline LanePath concentric_lane(const std::string& id, double kappa, double offset,
                                std::uint32_t priority = 0, double length = 100.0) {
  const double stretch = 1.0 - kappa * offset;
  const Pose2 start = along_arc(Pose2(), kappa, -2.0).to_parent(Pose2(Point2(0.0, offset), 0.0));
  return lane(id, arc(start, kappa / stretch, length * stretch, 0.5 * stretch), priority);
}

}  // namespace relative_map::core::test
