#include "relative_map/ros/localizer/localizer_engine.hpp"

#include <cmath>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

Eigen::Vector3d vector_of(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

core::Time stamp_of(const std_msgs::Header& header, const ros::Time& received) {
  return to_core(header.stamp.isZero() ? received : header.stamp);
}

/// What the chassis and odometry say alike; the yaw rate may be NaN.
core::WheelSpeed wheels_of(const geometry_msgs::Twist& twist) {
  core::WheelSpeed wheels;
  wheels.speed = twist.linear.x;
  wheels.yaw_rate = twist.angular.z;
  return wheels;
}

}  // namespace

LocalizerEngine::LocalizerEngine(const LocalizerNodeConfig& config, LinkTransforms transforms,
                                 double wait_for_frames)
    : config_(config),
      transforms_(std::move(transforms)),
      wait_for_frames_(wait_for_frames),
      localizer_(config.localizer) {}

std::vector<std::string> LocalizerEngine::take_remarks() {
  std::vector<std::string> remarks = std::exchange(remarks_, {});
  for (std::string& remark : localizer_.take_remarks()) remarks.push_back(std::move(remark));
  return remarks;
}

std::optional<Eigen::Isometry3d> LocalizerEngine::mount_of(const char* name, const std::string& frame,
                                                           const ros::Time& received) {
  Mount& mount = mounts_[std::string(name) + " " + frame];
  if (mount.base_from_frame) return mount.base_from_frame;
  if (mount.asked.isZero()) mount.asked = received;
  mount.base_from_frame = transforms_(config_.base_frame, frame_name(frame), received);
  if (!mount.base_from_frame && (received - mount.asked).toSec() >= wait_for_frames_) {
    remarks_.push_back(std::string(name) + ": no transform from '" + frame + "' to '" + config_.base_frame +
                       "': it is taken to be at that frame's origin, with its axes");
    mount.base_from_frame = Eigen::Isometry3d::Identity();
  }
  return mount.base_from_frame;
}

void LocalizerEngine::on_imu(const sensor_msgs::Imu& message, const ros::Time& received) {
  const auto mount =
      config_.base_from_imu ? config_.base_from_imu : mount_of("imu", message.header.frame_id, received);
  if (!mount) return;
  localizer_.set_imu_place(mount->translation());
  localizer_.add_imu(stamp_of(message.header, received),
                     {mount->rotation() * vector_of(message.angular_velocity),
                      mount->rotation() * vector_of(message.linear_acceleration)});
}

void LocalizerEngine::on_fix(const sensor_msgs::NavSatFix& message, const ros::Time& received) {
  std::optional<Eigen::Vector3d> place = config_.base_from_antenna;
  if (!place) {
    const auto mount = mount_of("fix", message.header.frame_id, received);
    if (!mount) return;
    place = mount->translation();
  }
  localizer_.set_antenna_place(*place);
  core::FixReading fix;
  fix.place = {message.longitude, message.latitude, message.altitude};
  fix.covariance =
      Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(message.position_covariance.data());
  fix.covariance_known = message.position_covariance_type != sensor_msgs::NavSatFix::COVARIANCE_TYPE_UNKNOWN;
  fix.status = message.status.status;
  localizer_.add_fix(stamp_of(message.header, received), fix);
}

void LocalizerEngine::on_fix_velocity(const geometry_msgs::TwistStamped& message, const ros::Time& received) {
  localizer_.add_fix_velocity(stamp_of(message.header, received), vector_of(message.twist.linear),
                              core::kNotGiven);
}

void LocalizerEngine::on_fix_velocity(const geometry_msgs::TwistWithCovarianceStamped& message,
                                      const ros::Time& received) {
  const auto& covariance = message.twist.covariance;
  localizer_.add_fix_velocity(stamp_of(message.header, received), vector_of(message.twist.twist.linear),
                              std::sqrt(std::max(covariance[0], covariance[7])));
}

void LocalizerEngine::on_heading(const sensor_msgs::Imu& message, const ros::Time& received) {
  const auto& q = message.orientation;
  const Eigen::Quaterniond given(q.w, q.x, q.y, q.z);
  if (!(std::abs(given.norm() - 1.0) < 0.1) || message.orientation_covariance[0] < 0.0) {
    remarks_.push_back("heading: it has no orientation; it is dropped");
    return;
  }
  const auto mount = mount_of("heading", message.header.frame_id, received);
  if (!mount) return;
  const Eigen::Vector3d forward =
      given.normalized() * (mount->rotation().transpose() * Eigen::Vector3d::UnitX());
  localizer_.add_heading(stamp_of(message.header, received), std::atan2(forward.y(), forward.x()),
                         std::sqrt(message.orientation_covariance[8]));
}

void LocalizerEngine::on_wheels(const geometry_msgs::TwistStamped& message, const ros::Time& received) {
  localizer_.add_wheels(stamp_of(message.header, received), wheels_of(message.twist));
}

void LocalizerEngine::on_wheels(const nav_msgs::Odometry& message, const ros::Time& received) {
  localizer_.add_wheels(stamp_of(message.header, received), wheels_of(message.twist.twist));
}

void LocalizerEngine::on_chassis(const Chassis& message, const ros::Time& received) {
  const core::Chassis chassis = to_core(message, received);
  localizer_.add_wheels(chassis.stamp, {chassis.speed, core::kNotGiven, chassis.sign_known});
}

void LocalizerEngine::on_map_pose(const geometry_msgs::PoseWithCovarianceStamped& message,
                                  const ros::Time& received) {
  const std::string frame = frame_name(message.header.frame_id);
  if (!frame.empty() && frame != config_.map_frame) {
    remarks_.push_back("map_pose: it is in frame '" + frame + "', and not in '" + config_.map_frame +
                       "'; it is dropped");
    return;
  }
  const auto& pose = message.pose.pose;
  core::MapPoseReading reading;
  reading.position = {pose.position.x, pose.position.y, pose.position.z};
  reading.map_from_body =
      Eigen::Quaterniond(pose.orientation.w, pose.orientation.x, pose.orientation.y, pose.orientation.z);
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) {
      reading.position_covariance(row, column) = message.pose.covariance[6 * row + column];
    }
  }
  reading.yaw_variance = message.pose.covariance[35];
  localizer_.add_map_pose(stamp_of(message.header, received), reading);
}

}  // namespace relative_map
