#include "relative_map/ros/adapters/adapters_node.hpp"

#include <XmlRpcValue.h>
#include <tf2/exceptions.h>

#include <stdexcept>

#include "relative_map/ros/adapters/lane_paths.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

/// Reads parameters and gathers what is wrong with them.
class Reader {
 public:
  explicit Reader(const ros::NodeHandle& nh) : nh_(nh) {}

  template <class T>
  void read(const std::string& name, T& value) {
    if (nh_.hasParam(name) && !nh_.getParam(name, value)) faults_ += "\n  - " + name + " is of another type";
  }
  void frame(const std::string& name, std::string& value) {
    read(name, value);
    value = frame_name(value);
    if (value.empty()) faults_ += "\n  - " + name + " is empty, but must name a frame";
  }
  void refuse_if(bool bad, const std::string& fault) {
    if (bad) faults_ += "\n  - " + fault;
  }
  void finish() const {
    if (!faults_.empty()) throw std::runtime_error("the configuration is refused:" + faults_);
  }

 private:
  const ros::NodeHandle& nh_;
  std::string faults_;
};

}  // namespace

AdaptersConfig load_adapters_config(const ros::NodeHandle& private_nh) {
  AdaptersConfig config;
  Reader reader(private_nh);
  reader.frame("base_frame", config.base_frame);
  reader.frame("map_frame", config.map_frame);
  reader.read("odometry", config.odometry);
  reader.read("tf_localization", config.tf_localization);
  reader.read("twist", config.twist);
  reader.read("paths", config.paths);
  reader.read("left_marker_path", config.left_marker_path);
  reader.read("right_marker_path", config.right_marker_path);
  reader.read("max_marker_residual", config.max_marker_residual);
  reader.read("publish_lane_paths", config.publish_lane_paths);
  reader.refuse_if(!(config.max_marker_residual > 0.0 && config.max_marker_residual <= 1.0),
                   "max_marker_residual must be above 0 and at most 1 m");
  reader.refuse_if(!config.odometry.empty() && config.tf_localization,
                   "odometry and tf_localization are both set: localization must have one source");
  reader.finish();
  return config;
}

AdaptersNode::AdaptersNode(ros::NodeHandle nh, ros::NodeHandle private_nh)
    : nh_(nh),
      private_nh_(private_nh),
      log_(private_nh.getNamespace()),
      config_(load_adapters_config(private_nh)),
      chassis_from_twist_(config_.base_frame, link_transforms(transforms_)),
      path_lines_(config_.paths),
      marker_pairing_(config_.max_marker_residual) {
  const bool from_links = config_.tf_localization || !config_.twist.empty();
  if (from_links) {
    for (const bool is_static : {true, false}) {
      subscribers_.push_back(
          nh_.subscribe<tf2_msgs::TFMessage>(is_static ? "/tf_static" : "/tf", 100,
                                             [this, is_static](const tf2_msgs::TFMessageConstPtr& message) {
                                               on_transforms(*message, is_static);
                                             }));
    }
  }
  subscribe_localization();
  subscribe_twist();
  subscribe_paths();
  subscribe_markers();
  subscribe_map();
}

void AdaptersNode::complain(const std::string& complaint) {
  if (complaints_.due(complaint, ros::WallTime::now())) log_.warn(complaint);
}

void AdaptersNode::subscribe_localization() {
  if (config_.odometry.empty() && !config_.tf_localization) return;
  localization_ = nh_.advertise<LocalizationEstimate>("localization", 100);
  if (config_.odometry.empty()) return;
  subscribers_.push_back(nh_.subscribe<nav_msgs::Odometry>(
      config_.odometry, 100,
      [this](const nav_msgs::OdometryConstPtr& odometry) {
        localization_.publish(localization_from(*odometry));
      },
      ros::VoidConstPtr(), ros::TransportHints().tcpNoDelay()));
}

/// Each new time at which the whole way from the map to the vehicle is known gives a pose: never one that is
/// older than its stamp says.
void AdaptersNode::on_transforms(const tf2_msgs::TFMessage& message, bool is_static) {
  add_transforms(message, is_static, transforms_);
  if (!config_.tf_localization) return;
  try {
    geometry_msgs::TransformStamped pose =
        transforms_.lookupTransform(config_.map_frame, config_.base_frame, ros::Time(0));
    const ros::Time stamp = pose.header.stamp;
    if (stamp.isZero() || stamp == tf_stamp_) return;  // nothing of it moves, or nothing is new
    if (stamp < tf_stamp_) transforms_.clear();        // time has begun anew
    tf_stamp_ = stamp;
    localization_.publish(localization_from(pose));
  } catch (const tf2::TransformException& fault) {
    complain("tf_localization: no transform from '" + config_.map_frame + "' to '" + config_.base_frame +
             "' yet: " + fault.what());
  }
}

void AdaptersNode::subscribe_twist() {
  if (config_.twist.empty()) return;
  chassis_ = nh_.advertise<Chassis>("chassis", 100);
  subscribers_.push_back(nh_.subscribe<topic_tools::ShapeShifter>(
      config_.twist, 100,
      [this](const topic_tools::ShapeShifter::ConstPtr& message) { on_twist(*message); }));
}

void AdaptersNode::on_twist(const topic_tools::ShapeShifter& message) {
  std::optional<Chassis> chassis;
  if (message.getDataType() == "geometry_msgs/TwistStamped") {
    chassis = chassis_from_twist_.convert(*message.instantiate<geometry_msgs::TwistStamped>());
  } else if (message.getDataType() == "geometry_msgs/TwistWithCovarianceStamped") {
    chassis = chassis_from_twist_.convert(*message.instantiate<geometry_msgs::TwistWithCovarianceStamped>());
  } else {
    complain("twist: " + config_.twist + " has type " + message.getDataType() +
             ", but geometry_msgs/TwistStamped or TwistWithCovarianceStamped is needed");
    return;
  }
  if (chassis) {
    chassis_.publish(*chassis);
  } else {
    complain("twist: the place of its frame on the vehicle is not known: no static transform to '" +
             config_.base_frame + "'");
  }
}

void AdaptersNode::subscribe_paths() {
  if (config_.paths.empty()) return;
  navigation_ = nh_.advertise<NavigationInfo>("navigation", 1, true);
  for (const std::string& topic : config_.paths) {
    subscribers_.push_back(
        nh_.subscribe<nav_msgs::Path>(topic, 1, [this, topic](const nav_msgs::PathConstPtr& path) {
          const PathLines::Answer answer = path_lines_.add(topic, *path);
          if (!answer.fault.empty()) complain("paths: " + answer.fault);
          if (answer.lines) navigation_.publish(*answer.lines);
        }));
  }
}

void AdaptersNode::subscribe_markers() {
  if (config_.left_marker_path.empty() && config_.right_marker_path.empty()) return;
  markers_ = nh_.advertise<LaneMarkers>("perception/lane_markers", 10);
  for (const bool is_left : {true, false}) {
    const std::string& topic = is_left ? config_.left_marker_path : config_.right_marker_path;
    if (topic.empty()) continue;
    subscribers_.push_back(nh_.subscribe<nav_msgs::Path>(
        topic, 10,
        [this, is_left](const nav_msgs::PathConstPtr& paint) { on_marker_path(is_left, *paint); }));
  }
}

void AdaptersNode::on_marker_path(bool is_left, const nav_msgs::Path& paint) {
  const MarkerPairing::Answer answer = marker_pairing_.add(is_left, paint, ros::Time::now());
  const std::string& topic = is_left ? config_.left_marker_path : config_.right_marker_path;
  if (!answer.fitted.fault.empty()) {
    complain(topic + ": not used: " + answer.fitted.fault);
  } else {
    if (complaints_.due(topic + ": residual", ros::WallTime::now())) {
      log_.info(topic + ": a cubic fits its points to " + std::to_string(answer.fitted.residual) +
                " m (RMS) up to " + std::to_string(answer.fitted.marker.view_range) + " m ahead" +
                (answer.fitted.left_out > 0.0 ? "; the last " + std::to_string(answer.fitted.left_out) +
                                                    " m do not fit and are left out"
                                              : ""));
    }
  }
  if (answer.markers) markers_.publish(*answer.markers);
}

void AdaptersNode::subscribe_map() {
  if (!config_.publish_lane_paths) return;
  for (const std::string place : {"current", "left_1", "right_1"}) {
    for (const std::string curve : {"/centerline", "/left_border", "/right_border"}) {
      lane_paths_[place + curve] = private_nh_.advertise<nav_msgs::Path>("lanes/" + place + curve, 1);
    }
  }
  subscribers_.push_back(
      nh_.subscribe<MapMsg>("relative_map", 1, [this](const MapMsgConstPtr& map) { on_map(*map); }));
}

/// A lane that is no more gets an empty path: nobody must drive on by the last one.
void AdaptersNode::on_map(const MapMsg& map) {
  const std::map<std::string, nav_msgs::Path> paths = lane_paths(map);
  for (const auto& [name, path] : paths) {
    ros::Publisher& publisher = lane_paths_[name];
    if (!publisher) publisher = private_nh_.advertise<nav_msgs::Path>("lanes/" + name, 1);
    publisher.publish(path);
  }
  nav_msgs::Path none;
  none.header = map.header;
  for (const auto& [name, publisher] : lane_paths_) {
    if (paths.count(name) == 0) publisher.publish(none);
  }
}

}  // namespace relative_map
