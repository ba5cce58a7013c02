#pragma once

#include <string>
#include <vector>

namespace relative_map::core {

/// How the vehicle is found on its route, and how much of the route is told.
struct RouteParam {
  double max_distance = 10.0;              ///< [m] beside the route; farther away the vehicle is off it
  double max_heading = 1.5708;             ///< [rad] between vehicle and lane; beyond it, it is the wrong way
  double look_back = 50.0;                 ///< [m] of segments behind the vehicle
  double look_ahead = 180.0;               ///< [m] of segments ahead of it, and
  double look_ahead_fast = 250.0;          ///< [m] of a vehicle that drives fast, and
  double look_ahead_time = 8.0;            ///< [s] at least as far as it drives in this time
  double max_lane_change_distance = 20.0;  ///< [m] beside a passage; farther away it can't be changed to
  double lane_gap = 0.3;                   ///< [m] that two lanes may be apart that a vehicle changes between

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
  /// [m] ahead at a speed [m/s], without a step: look_ahead up to the speed at which that is look_ahead_time,
  /// look_ahead_fast from a little above it, and look_ahead_time beyond that.
  double ahead(double speed) const;
};

}  // namespace relative_map::core
