#include "relative_map/localization/inertial_filter/navigation_state.hpp"

namespace relative_map::core {

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  Eigen::Matrix3d m;
  m << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return m;
}

Eigen::Matrix3d rotation_by(const Eigen::Vector3d& angle) {
  // Rodrigues; the series near zero, where its quotients lose their digits.
  const double squared = angle.squaredNorm(), length = std::sqrt(squared);
  const double a = length < 1e-4 ? 1.0 - squared / 6.0 : std::sin(length) / length;
  const double b = length < 1e-4 ? 0.5 - squared / 24.0 : (1.0 - std::cos(length)) / squared;
  const Eigen::Matrix3d k = cross_matrix(angle);
  return Eigen::Matrix3d::Identity() + a * k + b * k * k;
}

void inject(const ErrorState& error, NavigationState& state, ErrorCovariance& covariance) {
  state.position += error.segment<3>(error::kPosition);
  state.velocity += error.segment<3>(error::kVelocity);
  const Eigen::Vector3d turn = error.segment<3>(error::kAttitude);
  // Through a quaternion: a product of many matrices would cease to be a rotation.
  state.attitude = Eigen::Quaterniond(state.attitude * rotation_by(turn)).normalized().toRotationMatrix();
  state.gyro_bias += error.segment<3>(error::kGyroBias);
  state.accel_bias += error.segment<3>(error::kAccelBias);
  state.wheel_scale += error(error::kWheelScale);
  state.mount_pitch += error(error::kMountPitch);
  state.mount_yaw += error(error::kMountYaw);
  state.stamp_offset += error(error::kStampOffset);
  const Eigen::Matrix3d reset = Eigen::Matrix3d::Identity() - 0.5 * cross_matrix(turn);
  covariance.middleRows<3>(error::kAttitude) =
      reset.lazyProduct(covariance.middleRows<3>(error::kAttitude)).eval();
  covariance.middleCols<3>(error::kAttitude) =
      covariance.middleCols<3>(error::kAttitude).lazyProduct(reset.transpose()).eval();
}

}  // namespace relative_map::core
