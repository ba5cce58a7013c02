#include "relative_map/ros/adapters/standard_inputs.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kStanding = 0.05;  // [m/s] slower is noise, and tells no gear

using Covariance = boost::array<double, 36>;

Eigen::Vector3d to_eigen(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

geometry_msgs::Vector3 to_message(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

geometry_msgs::Vector3 not_given() {
  return to_message(Eigen::Vector3d::Constant(kNaN));
}

/// A unit quaternion's rotation; none of what is no direction.
std::optional<Eigen::Matrix3d> rotation_of(const geometry_msgs::Quaternion& q) {
  const Eigen::Quaterniond quaternion(q.w, q.x, q.y, q.z);
  const double norm = quaternion.norm();
  if (!(norm > 1e-3 && std::isfinite(norm))) return std::nullopt;
  return quaternion.normalized().toRotationMatrix();
}

/// Rows and columns `first` to `first` + 2 of a covariance matrix.
Eigen::Matrix3d block_of(const Covariance& covariance, int first) {
  const Eigen::Map<const Eigen::Matrix<double, 6, 6, Eigen::RowMajor>> whole(covariance.data());
  return whole.block<3, 3>(first, first);
}

geometry_msgs::Vector3 std_dev(const Eigen::Matrix3d& covariance) {
  // A variance of 0 or -1 is how publishers say that they do not know.
  const Eigen::Array3d variance = covariance.diagonal().array();
  return to_message((variance > 0.0).select(variance.abs().sqrt(), kNaN).matrix());
}

/// [rad] roll, pitch, yaw
geometry_msgs::Vector3 euler_angles(const Eigen::Matrix3d& r) {
  return to_message({std::atan2(r(2, 1), r(2, 2)), -std::asin(std::min(1.0, std::max(-1.0, r(2, 0)))),
                     std::atan2(r(1, 0), r(0, 0))});
}

LocalizationEstimate pose_alone(const std_msgs::Header& header, const std::string& link,
                                const geometry_msgs::Quaternion& orientation) {
  LocalizationEstimate localization;
  localization.header = header;
  localization.header.frame_id = frame_name(header.frame_id);
  localization.child_frame_id = frame_name(link);
  Pose& pose = localization.pose;
  pose.orientation = orientation;
  pose.heading = kNaN;  // the orientation's
  const auto rotation = rotation_of(orientation);
  pose.euler_angles = rotation ? euler_angles(*rotation) : not_given();
  pose.linear_velocity = pose.angular_velocity = pose.angular_velocity_vrf = not_given();
  pose.linear_acceleration = pose.linear_acceleration_vrf = not_given();
  Uncertainty& uncertainty = localization.uncertainty;
  uncertainty.position_std_dev = uncertainty.orientation_std_dev = uncertainty.linear_velocity_std_dev =
      uncertainty.angular_velocity_std_dev = uncertainty.linear_acceleration_std_dev = not_given();
  return localization;
}

}  // namespace

LocalizationEstimate localization_from(const nav_msgs::Odometry& odometry) {
  LocalizationEstimate localization =
      pose_alone(odometry.header, odometry.child_frame_id, odometry.pose.pose.orientation);
  localization.pose.position = odometry.pose.pose.position;
  localization.uncertainty.position_std_dev = std_dev(block_of(odometry.pose.covariance, 0));
  localization.uncertainty.orientation_std_dev = std_dev(block_of(odometry.pose.covariance, 3));
  const auto map_from_child = rotation_of(odometry.pose.pose.orientation);
  if (!map_from_child) return localization;
  const Eigen::Vector3d velocity = to_eigen(odometry.twist.twist.linear);
  const Eigen::Vector3d rates = to_eigen(odometry.twist.twist.angular);
  localization.pose.linear_velocity = to_message(*map_from_child * velocity);
  localization.pose.angular_velocity = to_message(*map_from_child * rates);
  localization.pose.angular_velocity_vrf = odometry.twist.twist.angular;
  localization.uncertainty.linear_velocity_std_dev =
      std_dev(*map_from_child * block_of(odometry.twist.covariance, 0) * map_from_child->transpose());
  localization.uncertainty.angular_velocity_std_dev = std_dev(block_of(odometry.twist.covariance, 3));
  return localization;
}

LocalizationEstimate localization_from(const geometry_msgs::TransformStamped& map_from_link) {
  LocalizationEstimate localization =
      pose_alone(map_from_link.header, map_from_link.child_frame_id, map_from_link.transform.rotation);
  localization.pose.position.x = map_from_link.transform.translation.x;
  localization.pose.position.y = map_from_link.transform.translation.y;
  localization.pose.position.z = map_from_link.transform.translation.z;
  return localization;
}

std::optional<Chassis> ChassisFromTwist::convert(const geometry_msgs::TwistStamped& twist) {
  return convert(twist.header, twist.twist);
}

std::optional<Chassis> ChassisFromTwist::convert(const geometry_msgs::TwistWithCovarianceStamped& twist) {
  return convert(twist.header, twist.twist.twist);
}

std::optional<Chassis> ChassisFromTwist::convert(const std_msgs::Header& header,
                                                 const geometry_msgs::Twist& twist) {
  Eigen::Vector3d velocity = to_eigen(twist.linear);
  const std::string link = header.frame_id.empty() ? base_frame_ : frame_name(header.frame_id);
  if (link != base_frame_) {
    const auto base_from_link = transforms_(base_frame_, link, header.stamp);
    if (!base_from_link) return std::nullopt;
    const Eigen::Matrix3d rotation = base_from_link->rotation();
    const Eigen::Vector3d rates = rotation * to_eigen(twist.angular);
    velocity = rotation * velocity - rates.cross(base_from_link->translation());
  }
  Chassis chassis;
  chassis.header = header;
  chassis.header.frame_id = base_frame_;
  chassis.engine_started = true;
  chassis.speed_mps = std::abs(velocity.x());
  if (velocity.x() < -kStanding) gear_ = Chassis::GEAR_REVERSE;
  if (velocity.x() > kStanding) gear_ = Chassis::GEAR_DRIVE;
  chassis.gear_location = gear_;
  chassis.driving_mode = Chassis::COMPLETE_MANUAL;
  chassis.throttle_percentage = chassis.brake_percentage = kNaN;
  chassis.steering_percentage = chassis.steering_torque_nm = kNaN;
  return chassis;
}

}  // namespace relative_map
