#pragma once

#include <Eigen/Core>
#include <optional>

#include "relative_map/model/road_users.hpp"

namespace relative_map::core {

constexpr int kEgoSteps = 30;  ///< of 0.1 s, the first at 0.1 s

/// The vehicle's own plan as a network is told of it: x y [m], theta [rad], v [m/s], a [m/s^2], kappa [1/m],
/// in the frame of a road user; none: it has no plan of 3 s.
std::optional<Eigen::Matrix<double, kEgoSteps, 6>> ego_features(const EgoVehicle& ego, const Pose2& frame);

}  // namespace relative_map::core
