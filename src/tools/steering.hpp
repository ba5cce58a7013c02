#pragma once

#include <vector>

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

/// What a vehicle has to do with its wheels at a point of a path.
struct Steering {
  double before = 0.0, after = 0.0;  ///< [1/m] mean curvature over the metre before, and after
  double speed = 0.0;                ///< [m/s] that such a curve is driven at
  double rate = 0.0;                 ///< [1/(m s)] of the curvature at that speed
};

/// One a point; all zero at points that the path does not go on for a metre from. `length` [m] is that of a
/// lap, its closing segment included.
std::vector<Steering> steering_along(const PathPoints& path, Ends ends, double length);

}  // namespace relative_map::core
