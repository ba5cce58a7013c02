#pragma once

#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <relative_map/MapMsg.h>
#include <ros/ros.h>
#include <tf2/buffer_core.h>
#include <topic_tools/shape_shifter.h>

#include <map>
#include <string>
#include <vector>

#include "relative_map/ros/adapters/marker_fit.hpp"
#include "relative_map/ros/adapters/path_lines.hpp"
#include "relative_map/ros/adapters/standard_inputs.hpp"
#include "relative_map/ros/health/node_log.hpp"
#include "relative_map/ros/health/throttled_log.hpp"

namespace relative_map {

/// What the adapters are told; see config/adapters.yaml. An empty topic: that adapter is off.
struct AdaptersConfig {
  std::string base_frame = "base_link";
  std::string map_frame = "map";
  std::string odometry;            ///< topic of nav_msgs/Odometry
  bool tf_localization = false;    ///< localization from the transforms map_frame -> base_frame
  std::string twist;               ///< topic of TwistStamped or TwistWithCovarianceStamped
  std::vector<std::string> paths;  ///< topics of nav_msgs/Path, the best first
  std::string left_marker_path;    ///< topics of nav_msgs/Path in a sensor's frame
  std::string right_marker_path;
  double max_marker_residual = 0.10;  ///< [m] RMS of paint from its cubic, above which it is not used
  bool publish_lane_paths = false;    ///< ~lanes/... from relative_map
};

/// Reads ~ parameters; throws std::runtime_error that names every bad one.
AdaptersConfig load_adapters_config(const ros::NodeHandle& private_nh);

/// Topics around the conversions: this package's inputs out of standard messages, and paths out of its maps.
/// All runs on the callback queue of the node handles.
class AdaptersNode {
 public:
  AdaptersNode(ros::NodeHandle nh, ros::NodeHandle private_nh);

 private:
  void subscribe_localization();
  void subscribe_twist();
  void subscribe_paths();
  void subscribe_markers();
  void subscribe_map();
  void on_transforms(const tf2_msgs::TFMessage& message, bool is_static);
  void on_twist(const topic_tools::ShapeShifter& message);
  void on_marker_path(bool is_left, const nav_msgs::Path& paint);
  void on_map(const MapMsg& map);
  void complain(const std::string& complaint);

  ros::NodeHandle nh_, private_nh_;
  NodeLog log_;
  AdaptersConfig config_;
  ThrottledLog complaints_;
  tf2::BufferCore transforms_;
  ChassisFromTwist chassis_from_twist_;
  PathLines path_lines_;
  MarkerPairing marker_pairing_;
  ros::Time tf_stamp_;  ///< of the newest pose out of tf
  ros::Publisher localization_, chassis_, navigation_, markers_;
  std::map<std::string, ros::Publisher> lane_paths_;

  std::vector<ros::Subscriber> subscribers_;  ///< what calls back goes first
};

}  // namespace relative_map
