#pragma once

#include "relative_map/localization/inertial_filter/navigation_state.hpp"
#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// What a measurement says against what was expected of it, and how the error state shows in that.
template <int Rows>
struct Observation {
  Eigen::Matrix<double, Rows, 1> innovation;
  Eigen::Matrix<double, Rows, error::kCount> jacobian = Eigen::Matrix<double, Rows, error::kCount>::Zero();
  Eigen::Matrix<double, Rows, Rows> noise;
};

/// How the sensor moves now, beside its state.
struct Motion {
  Eigen::Vector3d rate = Eigen::Vector3d::Zero();          ///< [rad/s] body, without its bias
  Eigen::Vector3d acceleration = Eigen::Vector3d::Zero();  ///< [m/s^2] in the plane, smoothed
};

/// A point of the body, `lever` [m] from the sensor in its axes, was seen at `position` [m] in the plane. It
/// was seen `stamp_offset` after the state's time, in which it moved on.
Observation<3> observe_position(const NavigationState& state, const Motion& motion,
                                const Eigen::Vector3d& lever, const Eigen::Vector3d& position,
                                const Eigen::Matrix3d& noise);
/// Its velocity [m/s] in the plane, likewise.
Observation<3> observe_velocity(const NavigationState& state, const Motion& motion,
                                const Eigen::Vector3d& lever, const Eigen::Vector3d& velocity,
                                const Eigen::Matrix3d& noise);
/// The yaw [rad] of the body in the plane; the innovation is on the circle.
Observation<1> observe_heading(const NavigationState& state, double heading, double stddev);
/// The axle at `lever` rolls at `speed` [m/s] by its wheels.
Observation<1> observe_wheel_speed(const NavigationState& state, const Motion& motion,
                                   const Eigen::Vector3d& lever, double speed, double stddev);
/// It moves neither sideways nor up (the non-holonomic constraint).
Observation<2> observe_rolling(const NavigationState& state, const Motion& motion,
                               const Eigen::Vector3d& lever, double lateral_stddev, double vertical_stddev);
/// The sensor does not move, and does not turn but with the earth (`earth_rate` in the plane).
Observation<3> observe_standing(const NavigationState& state, double stddev);
Observation<3> observe_no_turning(const NavigationState& state, const Eigen::Vector3d& mean_rate,
                                  const Eigen::Vector3d& earth_rate, double stddev);

/// [m/s] of the axle at `lever`: forward, left, up, in axes that its wheels roll along.
Eigen::Vector3d axle_velocity(const NavigationState& state, const Motion& motion,
                              const Eigen::Vector3d& lever);

}  // namespace relative_map::core
