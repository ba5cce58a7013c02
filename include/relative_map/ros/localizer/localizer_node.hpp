#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>
#include <tf2_ros/transform_broadcaster.h>
#include <tf2_ros/transform_listener.h>

#include <deque>
#include <memory>

#include "relative_map/ros/health/throttled_log.hpp"
#include "relative_map/ros/localizer/localizer_engine.hpp"

namespace topic_tools {
class ShapeShifter;
}

namespace relative_map {

/// Topics, timers and services around the localizer's engine; the nodelet and the stand-alone node are shells
/// of it. All callbacks run on the callback queue of the node handles, one after the other.
class LocalizerNode {
 public:
  /// Throws std::runtime_error that names every bad parameter, before anything is advertised.
  LocalizerNode(ros::NodeHandle nh, ros::NodeHandle private_nh);
  ~LocalizerNode();

 private:
  template <class Message, class Handler>
  ros::Subscriber subscribe(const std::string& topic, Handler handler);
  void on_fix_velocity(const topic_tools::ShapeShifter& message);
  void on_wheel_odometry(const topic_tools::ShapeShifter& message);
  void publish();
  void draw(const core::PoseEstimate& estimate);
  bool on_reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_align(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool on_set_datum(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  void summarize(diagnostic_updater::DiagnosticStatusWrapper& status);

  ros::NodeHandle nh_, private_nh_;
  LocalizerNodeConfig config_;
  tf2_ros::Buffer transforms_;
  tf2_ros::TransformListener transform_listener_;
  tf2_ros::TransformBroadcaster broadcaster_;
  LocalizerEngine engine_;
  ThrottledLog log_;
  core::PoseEstimate last_;
  bool any_ = false;
  std::string last_remark_;
  ros::WallTime last_remark_time_, last_drawn_;
  std::deque<std::pair<Eigen::Vector3d, core::EstimateCode>> path_;  ///< of the markers

  ros::Publisher localization_publisher_, odometry_publisher_, markers_publisher_;
  std::vector<ros::Subscriber> subscribers_;
  ros::ServiceServer reset_service_, align_service_, datum_service_;
  diagnostic_updater::Updater diagnostics_;
  ros::WallTimer diagnostics_timer_;
};

}  // namespace relative_map
