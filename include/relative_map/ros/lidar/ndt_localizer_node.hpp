#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <geometry_msgs/PoseWithCovarianceStamped.h>
#include <nav_msgs/Odometry.h>
#include <ros/ros.h>
#include <sensor_msgs/PointCloud2.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_listener.h>

#include <string>

#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/lidar/ndt_engine.hpp"
#include "relative_map/ros/setup/frames.hpp"

namespace relative_map {

/// Topics and services around the NDT engine; the nodelet and the stand-alone node are shells of it. All
/// callbacks run on the callback queue of the node handles, one after the other; only the map's tiles are
/// loaded on a thread of their own.
class NdtLocalizerNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, or why the map can't be read.
  NdtLocalizerNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~NdtLocalizerNode();

 private:
  void on_points(const sensor_msgs::PointCloud2ConstPtr& message);
  void on_odometry(const nav_msgs::OdometryConstPtr& message);
  void on_initial_pose(const geometry_msgs::PoseWithCovarianceStampedConstPtr& message);
  bool on_align(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);

  /// The cloud in the base frame; empty and a sentence in `fault` if that can't be.
  core::PointCloud base_cloud(const sensor_msgs::PointCloud2& message, std::string& fault);
  void publish(const NdtEngineResult& result, const ros::Time& stamp, double seconds);
  void complain(const std::string& sentence);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status) const;

  ros::NodeHandle nh_, private_nh_;
  NdtNodeConfig config_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  LinkTransforms link_transforms_;
  NdtEngine engine_;
  ThrottledLog log_;
  NdtEngineResult last_;
  std::string last_fault_;  ///< of the last cloud, if it was no match at all
  ros::WallTime last_cloud_;
  double last_seconds_ = 0.0;

  ros::Publisher pose_publisher_, verdict_publisher_;
  ros::Subscriber points_subscriber_, odometry_subscriber_, initial_pose_subscriber_;
  ros::ServiceServer align_service_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
};

}  // namespace relative_map
