#pragma once

#include <Eigen/Core>

namespace relative_map::core {

/// Normal gravity on the WGS 84 ellipsoid (Somigliana's closed formula), at a height above it by the usual
/// second-order expansion (Hofmann-Wellenhof and Moritz, Physical Geodesy, 2.215). [m/s^2], downwards.
/// Latitude [rad], height [m].
double normal_gravity(double latitude, double height);

/// Angular velocity of the earth [rad/s], in east, north, up at a latitude [rad].
Eigen::Vector3d earth_rate_enu(double latitude);

}  // namespace relative_map::core
