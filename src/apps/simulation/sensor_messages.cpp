#include "sensor_messages.hpp"

#include <cmath>
#include <limits>

namespace relative_map {

namespace {

geometry_msgs::Vector3 to_vector(const Eigen::Vector3d& v) {
  geometry_msgs::Vector3 message;
  message.x = v.x();
  message.y = v.y();
  message.z = v.z();
  return message;
}

}  // namespace

sensor_msgs::Imu to_message(const core::SimulatedImu& sample) {
  sensor_msgs::Imu message;
  message.header.frame_id = kImuFrame;
  message.orientation_covariance[0] = -1.0;  // there is no orientation, says sensor_msgs/Imu
  message.angular_velocity = to_vector(sample.angular_velocity);
  message.linear_acceleration = to_vector(sample.specific_force);
  return message;
}

sensor_msgs::NavSatFix to_message(const core::SimulatedFix& fix) {
  using sensor_msgs::NavSatStatus;
  sensor_msgs::NavSatFix message;
  message.header.frame_id = kAntennaFrame;
  message.status.service = NavSatStatus::SERVICE_GPS;
  if (fix.quality == core::FixQuality::kNoFix) {
    message.status.status = NavSatStatus::STATUS_NO_FIX;
    message.latitude = message.longitude = message.altitude = std::numeric_limits<double>::quiet_NaN();
    return message;
  }
  message.status.status =
      fix.quality == core::FixQuality::kPlain ? NavSatStatus::STATUS_FIX : NavSatStatus::STATUS_GBAS_FIX;
  message.latitude = fix.place.latitude;
  message.longitude = fix.place.longitude;
  message.altitude = fix.place.altitude;
  message.position_covariance[0] = message.position_covariance[4] = std::pow(fix.stddev, 2);
  message.position_covariance[8] = std::pow(fix.vertical_stddev, 2);
  message.position_covariance_type = sensor_msgs::NavSatFix::COVARIANCE_TYPE_DIAGONAL_KNOWN;
  return message;
}

geometry_msgs::TwistStamped to_message(const core::SimulatedVelocity& velocity) {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = "enu";
  message.twist.linear = to_vector(velocity.velocity);
  return message;
}

geometry_msgs::TwistStamped to_message(const core::SimulatedWheels& wheels, const std::string& base_frame) {
  geometry_msgs::TwistStamped message;
  message.header.frame_id = base_frame;
  message.twist.linear.x = wheels.speed;
  message.twist.angular.z = wheels.yaw_rate;
  return message;
}

}  // namespace relative_map
