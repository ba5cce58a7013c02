#include "relative_map/localization/inertial_filter/observations.hpp"

#include <cmath>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

using namespace error;

namespace {

/// Rows turn body axes into those that the axle rolls along; the mount's angles are small.
Eigen::Matrix3d axle_from_body(const NavigationState& state) {
  Eigen::Matrix3d m;
  m << 1.0, state.mount_yaw, -state.mount_pitch, -state.mount_yaw, 1.0, 0.0, state.mount_pitch, 0.0, 1.0;
  return m;
}

Eigen::Vector3d velocity_in_body(const NavigationState& state, const Motion& motion,
                                 const Eigen::Vector3d& lever) {
  return state.attitude.transpose() * state.velocity + motion.rate.cross(lever);
}

/// Of axle_velocity.
Eigen::Matrix<double, 3, kCount> axle_jacobian(const NavigationState& state, const Motion& motion,
                                               const Eigen::Vector3d& lever) {
  const Eigen::Matrix3d axle = axle_from_body(state);
  const double forward = velocity_in_body(state, motion, lever).x();
  Eigen::Matrix<double, 3, kCount> h = Eigen::Matrix<double, 3, kCount>::Zero();
  h.middleCols<3>(kVelocity) = axle * state.attitude.transpose();
  h.middleCols<3>(kAttitude) = axle * cross_matrix(state.attitude.transpose() * state.velocity);
  h.middleCols<3>(kGyroBias) = axle * cross_matrix(lever);
  const Eigen::Vector3d body = velocity_in_body(state, motion, lever);
  h.col(kMountYaw) << body.y(), -forward, 0.0;
  h.col(kMountPitch) << -body.z(), 0.0, forward;
  return h;
}

}  // namespace

Eigen::Vector3d axle_velocity(const NavigationState& state, const Motion& motion,
                              const Eigen::Vector3d& lever) {
  return axle_from_body(state) * velocity_in_body(state, motion, lever);
}

Observation<3> observe_position(const NavigationState& state, const Motion& motion,
                                const Eigen::Vector3d& lever, const Eigen::Vector3d& position,
                                const Eigen::Matrix3d& noise) {
  const Eigen::Vector3d velocity = state.velocity + state.attitude * motion.rate.cross(lever);
  const double later = state.stamp_offset;
  Observation<3> seen;
  seen.innovation = position - (state.position + state.attitude * lever + later * velocity +
                                0.5 * later * later * motion.acceleration);
  seen.jacobian.middleCols<3>(kPosition).setIdentity();
  seen.jacobian.middleCols<3>(kVelocity) = later * Eigen::Matrix3d::Identity();
  seen.jacobian.middleCols<3>(kAttitude) =
      -state.attitude * cross_matrix(lever + later * motion.rate.cross(lever));
  seen.jacobian.middleCols<3>(kGyroBias) = later * state.attitude * cross_matrix(lever);
  seen.jacobian.col(kStampOffset) = velocity + later * motion.acceleration;
  seen.noise = noise;
  return seen;
}

Observation<3> observe_velocity(const NavigationState& state, const Motion& motion,
                                const Eigen::Vector3d& lever, const Eigen::Vector3d& velocity,
                                const Eigen::Matrix3d& noise) {
  const Eigen::Vector3d around = motion.rate.cross(lever);
  Observation<3> seen;
  seen.innovation =
      velocity - (state.velocity + state.attitude * around + state.stamp_offset * motion.acceleration);
  seen.jacobian.middleCols<3>(kVelocity).setIdentity();
  seen.jacobian.middleCols<3>(kAttitude) = -state.attitude * cross_matrix(around);
  seen.jacobian.middleCols<3>(kGyroBias) = state.attitude * cross_matrix(lever);
  // Receivers smooth their velocity, which makes it later than their place: it tells nothing of the clocks.
  seen.noise = noise;
  return seen;
}

Observation<1> observe_heading(const NavigationState& state, double heading, double stddev) {
  const Eigen::Matrix3d forward = -state.attitude * cross_matrix(Eigen::Vector3d::UnitX());
  const double x = state.attitude(0, 0), y = state.attitude(1, 0);
  Observation<1> seen;
  seen.innovation << angle_difference(heading, state.yaw());
  seen.jacobian.middleCols<3>(kAttitude) = (x * forward.row(1) - y * forward.row(0)) / (x * x + y * y);
  seen.noise << stddev * stddev;
  return seen;
}

Observation<1> observe_wheel_speed(const NavigationState& state, const Motion& motion,
                                   const Eigen::Vector3d& lever, double speed, double stddev) {
  const double forward = axle_velocity(state, motion, lever).x();
  Observation<1> seen;
  seen.innovation << speed - state.wheel_scale * forward;
  seen.jacobian = state.wheel_scale * axle_jacobian(state, motion, lever).row(0);
  seen.jacobian(kWheelScale) = forward;
  seen.noise << stddev * stddev;
  return seen;
}

Observation<2> observe_rolling(const NavigationState& state, const Motion& motion,
                               const Eigen::Vector3d& lever, double lateral_stddev, double vertical_stddev) {
  Observation<2> seen;
  seen.innovation = -axle_velocity(state, motion, lever).tail<2>();
  seen.jacobian = axle_jacobian(state, motion, lever).bottomRows<2>();
  seen.noise << lateral_stddev * lateral_stddev, 0.0, 0.0, vertical_stddev * vertical_stddev;
  return seen;
}

Observation<3> observe_standing(const NavigationState& state, double stddev) {
  Observation<3> seen;
  seen.innovation = -state.velocity;
  seen.jacobian.middleCols<3>(kVelocity).setIdentity();
  seen.noise = stddev * stddev * Eigen::Matrix3d::Identity();
  return seen;
}

Observation<3> observe_no_turning(const NavigationState& state, const Eigen::Vector3d& mean_rate,
                                  const Eigen::Vector3d& earth_rate, double stddev) {
  Observation<3> seen;
  seen.innovation = mean_rate - state.gyro_bias - state.attitude.transpose() * earth_rate;
  seen.jacobian.middleCols<3>(kGyroBias).setIdentity();
  seen.noise = stddev * stddev * Eigen::Matrix3d::Identity();
  return seen;
}

}  // namespace relative_map::core
