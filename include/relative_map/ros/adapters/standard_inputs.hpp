#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/Chassis.h>
#include <relative_map/LocalizationEstimate.h>

#include <optional>

#include "relative_map/ros/setup/frames.hpp"

// This package's inputs out of standard ROS messages. Pure functions.
namespace relative_map {

/// Pose in the frame of `header`, twist in the child's frame (REP 105, nav_msgs/Odometry), covariances as
/// standard deviations. What an Odometry can't tell (accelerations) is NaN; a variance of 0 or below is not
/// given.
LocalizationEstimate localization_from(const nav_msgs::Odometry& odometry);

/// The pose that a transform from the map frame to a link of the vehicle tells; velocities are not given.
LocalizationEstimate localization_from(const geometry_msgs::TransformStamped& map_from_link);

/// Speed [m/s] and gear of a vehicle whose base moves so: the gear is by the sign of the speed, and stays
/// what it was while the vehicle stands.
class ChassisFromTwist {
 public:
  /// `base_frame` is what an empty frame_id means; other links are carried over by `transforms`.
  ChassisFromTwist(std::string base_frame, LinkTransforms transforms)
      : base_frame_(std::move(base_frame)), transforms_(std::move(transforms)) {}

  /// None if the place of the twist's frame on the vehicle is not known.
  std::optional<Chassis> convert(const geometry_msgs::TwistStamped& twist);
  std::optional<Chassis> convert(const geometry_msgs::TwistWithCovarianceStamped& twist);

 private:
  std::optional<Chassis> convert(const std_msgs::Header& header, const geometry_msgs::Twist& twist);

  std::string base_frame_;
  LinkTransforms transforms_;
  uint8_t gear_ = Chassis::GEAR_DRIVE;
};

}  // namespace relative_map
