#pragma once

#include <Eigen/Geometry>

#include "relative_map/geometry/kalman_filter.hpp"
#include "relative_map/localization/geodesy/tangent_plane.hpp"

namespace relative_map::core {

/// Where each block of the error state begins. The first 15 move by themselves; what follows stays.
namespace error {
constexpr int kPosition = 0, kVelocity = 3, kAttitude = 6, kGyroBias = 9, kAccelBias = 12, kMoving = 15;
constexpr int kWheelScale = 15, kMountPitch = 16, kMountYaw = 17, kStampOffset = 18, kCount = 19;
}  // namespace error

using ErrorFilter = KalmanFilter<error::kCount>;
using ErrorState = ErrorFilter::State;
using ErrorCovariance = ErrorFilter::Covariance;

/// How the inertial sensor moves, and what it and the vehicle's measures are wrong by. Body axes (FLU) at the
/// sensor; positions and vectors in a tangent plane.
struct NavigationState {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();      ///< [m/s]
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();  ///< plane from body
  Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();     ///< [rad/s]
  Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();    ///< [m/s^2]
  double wheel_scale = 1.0;   ///< [-] speed that the wheels tell, by the true one
  double mount_pitch = 0.0;   ///< [rad] of the axle's forward direction in the body's axes, down positive
  double mount_yaw = 0.0;     ///< [rad] and left positive
  double stamp_offset = 0.0;  ///< [s] of the inertial sensor's stamps after the fixes': positive, it is late

  double yaw() const { return std::atan2(attitude(1, 0), attitude(0, 0)); }
};

/// [v] x, as a matrix.
Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v);
/// The rotation by a vector's length about it.
Eigen::Matrix3d rotation_by(const Eigen::Vector3d& angle);
/// Adds what a filter found the state to be wrong by. The attitude's error is a turn of the body, R
/// Exp(error), and small; the covariance of what is left of it hardly changes (to first order (I - [error /
/// 2] x), which is applied).
void inject(const ErrorState& error, NavigationState& state, ErrorCovariance& covariance);

}  // namespace relative_map::core
