#include <cmath>

#include "relative_map/ros/localizer/localizer_engine.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

template <class Message>
void set(Message& message, const Eigen::Vector3d& v) {
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
}

void set(geometry_msgs::Quaternion& message, const Eigen::Quaterniond& q) {
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  message.w = q.w();
}

Eigen::Vector3d stddev_of(const Eigen::Matrix3d& covariance) {
  return covariance.diagonal().cwiseSqrt();
}

std_msgs::Header header_of(const core::PoseEstimate& estimate, const LocalizerNodeConfig& config) {
  std_msgs::Header header;
  header.stamp = to_ros(estimate.stamp);
  header.frame_id = config.map_frame;
  return header;
}

}  // namespace

LocalizationEstimate to_message(const core::PoseEstimate& estimate, const LocalizerNodeConfig& config) {
  LocalizationEstimate message;
  message.header = header_of(estimate, config);
  message.child_frame_id = config.base_frame;
  message.measurement_time = message.header.stamp;
  const Eigen::Matrix3d attitude = estimate.map_from_body.toRotationMatrix();
  Pose& pose = message.pose;
  set(pose.position, estimate.position);
  set(pose.orientation, estimate.map_from_body);
  set(pose.linear_velocity, estimate.velocity);
  set(pose.linear_acceleration, attitude * estimate.acceleration_body);
  set(pose.angular_velocity, attitude * estimate.rate_body);
  pose.heading = estimate.heading;
  set(pose.linear_acceleration_vrf, estimate.acceleration_body);
  set(pose.angular_velocity_vrf, estimate.rate_body);
  pose.euler_angles.x = std::atan2(attitude(2, 1), attitude(2, 2));
  pose.euler_angles.y = std::atan2(-attitude(2, 0), std::hypot(attitude(2, 1), attitude(2, 2)));
  pose.euler_angles.z = std::atan2(attitude(1, 0), attitude(0, 0));
  Uncertainty& uncertainty = message.uncertainty;
  set(uncertainty.position_std_dev, stddev_of(estimate.position_covariance));
  set(uncertainty.orientation_std_dev, stddev_of(estimate.attitude_covariance));
  set(uncertainty.linear_velocity_std_dev, stddev_of(estimate.velocity_covariance));
  set(uncertainty.linear_acceleration_std_dev, Eigen::Vector3d::Constant(core::kNotGiven));
  set(uncertainty.angular_velocity_std_dev, Eigen::Vector3d::Constant(core::kNotGiven));
  message.status.code = estimate.code == core::EstimateCode::kOk        ? LocalizationStatus::OK
                        : estimate.code == core::EstimateCode::kWarning ? LocalizationStatus::WARNING
                                                                        : LocalizationStatus::ERROR;
  message.status.message = estimate.message;
  return message;
}

std::optional<nav_msgs::Odometry> to_odometry(const core::PoseEstimate& estimate,
                                              const LocalizerNodeConfig& config) {
  // Who reads it asks for no NaN.
  if (!estimate.position.allFinite() || !estimate.map_from_body.coeffs().allFinite() ||
      !estimate.velocity.allFinite()) {
    return std::nullopt;
  }
  nav_msgs::Odometry message;
  message.header = header_of(estimate, config);
  message.child_frame_id = config.base_frame;
  set(message.pose.pose.position, estimate.position);
  set(message.pose.pose.orientation, estimate.map_from_body);
  const Eigen::Matrix3d body_from_map = estimate.map_from_body.toRotationMatrix().transpose();
  set(message.twist.twist.linear, body_from_map * estimate.velocity);
  // A rate that is not seen, as roll and pitch of the planar method, is 0 with a variance that says so.
  constexpr double kUnknown = 1e6, kRate = 1e-4;  // [rad^2/s^2]
  set(message.twist.twist.angular,
      estimate.rate_body.unaryExpr([](double rate) { return std::isfinite(rate) ? rate : 0.0; }));
  for (int axis = 0; axis < 3; ++axis) {
    message.twist.covariance[7 * (axis + 3)] = std::isfinite(estimate.rate_body(axis)) ? kRate : kUnknown;
  }
  const Eigen::Matrix3d twist = body_from_map * estimate.velocity_covariance * body_from_map.transpose();
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      message.pose.covariance[6 * row + column] = estimate.position_covariance(row, column);
      message.pose.covariance[6 * (row + 3) + column + 3] = estimate.attitude_covariance(row, column);
      message.twist.covariance[6 * row + column] = twist(row, column);
    }
  }
  return message;
}

}  // namespace relative_map
