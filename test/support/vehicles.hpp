#pragma once

#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "support/lines.hpp"

// Prepared lines, and vehicles on them.
namespace relative_map::core::test {

/// A single line, ready to be driven on. Throws std::out_of_range if it is refused.
inline NavigationLine prepared(const Polyline& points, bool stitch_closed_lines = true) {
  IntakeParam param;
  param.stitch_closed_lines = stitch_closed_lines;
  return prepare_navigation_lines({"map", {recording(points)}}, param)->lines.at(0);
}

inline VehicleState vehicle_at(const Pose2& pose, double seconds = 1.0, double speed = 10.0) {
  VehicleState vehicle;
  vehicle.stamp = at_seconds(seconds);
  vehicle.map_from_base = pose;
  vehicle.speed = speed;
  return vehicle;
}

}  // namespace relative_map::core::test
