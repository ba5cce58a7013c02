#pragma once

#include "relative_map/localization/inertial_filter/inertial_param.hpp"
#include "relative_map/localization/inertial_filter/navigation_state.hpp"
#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// What the earth does to an inertial sensor at a place of a tangent plane.
struct EarthEffects {
  Eigen::Vector3d gravity = Eigen::Vector3d::Zero();  ///< [m/s^2] in the plane, as the ground lies there
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();     ///< [rad/s] of the earth, in the plane
};
EarthEffects earth_effects(const TangentPlane& plane, const Eigen::Vector3d& position);

/// Strapdown integration (Groves, Principles of GNSS, Inertial, and Multisensor Integrated Navigation
/// Systems, 5.2 and 5.4) over `dt` [s], with the mean of the samples at its ends. Returns the acceleration
/// [m/s^2] in the plane.
Eigen::Vector3d move(NavigationState& state, const ImuSample& mean, const EarthEffects& earth, double dt);

/// The error's transition over the same step, for the 15 states that move. `before`: the state before the
/// step.
Eigen::Matrix<double, error::kMoving, error::kMoving> transition(const NavigationState& before,
                                                                 const ImuSample& mean, double dt);

/// P = F P F' + Q, by the blocks of F that are not zero. Noise densities are integrated over the step, so
/// that P does not depend on the sensor's rate.
void predict_covariance(ErrorCovariance& covariance, const NavigationState& before, const ImuSample& mean,
                        const ImuNoise& noise, double dt);

}  // namespace relative_map::core
