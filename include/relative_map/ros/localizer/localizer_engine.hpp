#pragma once

#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <geometry_msgs/TwistStamped.h>
#include <geometry_msgs/TwistWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/Chassis.h>
#include <relative_map/LocalizationEstimate.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "relative_map/localization/localizer.hpp"
#include "relative_map/ros/localizer/localizer_parameters.hpp"
#include "relative_map/ros/setup/frames.hpp"

namespace relative_map {

/// Messages in, estimates out: all of the localizer's node but its topics, and what `localize` runs over a
/// bag. A stamp of zero reads as `received`.
class LocalizerEngine {
 public:
  /// `wait_for_frames` [s]: how long messages are held off for a transform that is not there yet.
  LocalizerEngine(const LocalizerNodeConfig& config, LinkTransforms transforms, double wait_for_frames);

  void on_imu(const sensor_msgs::Imu& message, const ros::Time& received);
  void on_fix(const sensor_msgs::NavSatFix& message, const ros::Time& received);
  void on_fix_velocity(const geometry_msgs::TwistStamped& message, const ros::Time& received);
  void on_fix_velocity(const geometry_msgs::TwistWithCovarianceStamped& message, const ros::Time& received);
  /// Of the orientation, yaw and its covariance count.
  void on_heading(const sensor_msgs::Imu& message, const ros::Time& received);
  void on_wheels(const geometry_msgs::TwistStamped& message, const ros::Time& received);
  void on_wheels(const nav_msgs::Odometry& message, const ros::Time& received);
  void on_chassis(const Chassis& message, const ros::Time& received);
  void on_map_pose(const geometry_msgs::PoseWithCovarianceStamped& message, const ros::Time& received);

  std::vector<core::PoseEstimate> take_estimates() { return localizer_.take_estimates(); }
  std::vector<std::string> take_remarks();
  core::Localizer& localizer() { return localizer_; }
  const LocalizerNodeConfig& config() const { return config_; }

 private:
  /// base_from_`frame`; identity with a remark if it is not known. None: to be asked for again.
  std::optional<Eigen::Isometry3d> mount_of(const char* name, const std::string& frame,
                                            const ros::Time& received);

  LocalizerNodeConfig config_;
  LinkTransforms transforms_;
  double wait_for_frames_;
  core::Localizer localizer_;
  struct Mount {
    ros::Time asked;
    std::optional<Eigen::Isometry3d> base_from_frame;
  };
  std::map<std::string, Mount> mounts_;  ///< by topic and frame
  std::vector<std::string> remarks_;
};

/// Both are the estimate; what is NaN in it is so in the first, and makes the second none.
LocalizationEstimate to_message(const core::PoseEstimate& estimate, const LocalizerNodeConfig& config);
std::optional<nav_msgs::Odometry> to_odometry(const core::PoseEstimate& estimate,
                                              const LocalizerNodeConfig& config);

}  // namespace relative_map
