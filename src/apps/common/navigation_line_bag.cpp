#include "navigation_line_bag.hpp"

#include <nav_msgs/Path.h>
#include <rosbag/view.h>
#include <std_msgs/String.h>

#include <cmath>
#include <limits>
#include <set>
#include <stdexcept>

#include "bag_input.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "whole_bag.hpp"

namespace relative_map {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kDefaultTopic = "/navigation_line";
constexpr const char* kHeaderSuffix = "_header";

std::string named(const std::string& topic) {
  return topic.empty() ? kDefaultTopic : topic;
}

std::set<std::string> topics_of(const std::string& name) {
  return {name, name + kHeaderSuffix};
}

}  // namespace

core::LineFile read_path_bag(const std::string& path, const std::string& topic) {
  rosbag::Bag bag;
  open_bag(path, bag);
  const std::string name = find_topic(bag, path, topic, {"nav_msgs/Path"});
  core::LineFile file;
  file.line.name = core::line_name(path);
  try {
    for (const rosbag::MessageInstance& instance :
         rosbag::View(bag, rosbag::TopicQuery(std::vector<std::string>{name, name + kHeaderSuffix}))) {
      if (const nav_msgs::PathConstPtr message = instance.instantiate<nav_msgs::Path>()) {
        file.line.points.clear();
        for (const geometry_msgs::PoseStamped& pose : message->poses) {
          const geometry_msgs::Point& p = pose.pose.position;
          file.line.points.push_back({p.x, p.y, p.z, kNaN, kNaN, kNaN, kNaN});
        }
        file.header.frame_id = frame_name(message->header.frame_id);
      } else if (const std_msgs::StringConstPtr header = instance.instantiate<std_msgs::String>()) {
        const std::string frame = file.header.frame_id;
        file.header = core::parse_line_header(header->data);
        if (!frame.empty()) file.header.frame_id = frame;
      }
    }
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ": cannot be read: " + fault.what());
  }
  if (file.line.points.empty()) throw std::runtime_error(path + ": has no points");
  return file;
}

void expect_path_bag_writable(const std::string& path, const std::string& topic) {
  expect_bag_writable(path, topics_of(named(topic)));
}

void write_path_bag(const std::string& path, const std::string& topic, const core::LineFile& file) {
  core::expect_finite_positions(path, file.line);
  const std::string name = named(topic);
  nav_msgs::Path message;
  message.header.frame_id = file.header.frame_id.empty() ? "map" : file.header.frame_id;
  for (const core::LinePoint& point : file.line.points) {
    geometry_msgs::PoseStamped pose;
    pose.header.frame_id = message.header.frame_id;
    pose.pose.position.x = point.x;
    pose.pose.position.y = point.y;
    pose.pose.position.z = std::isfinite(point.z) ? point.z : 0.0;
    const double half = std::isfinite(point.theta) ? 0.5 * point.theta : 0.0;
    pose.pose.orientation.z = std::sin(half);
    pose.pose.orientation.w = std::cos(half);
    message.poses.push_back(pose);
  }
  const ros::Time now(ros::WallTime::now().toSec());
  WholeBag bag(path, topics_of(name));
  bag.write(name, now, message);
  if (!core::is_empty(file.header)) {
    std_msgs::String header;
    header.data = core::to_json(file.header);
    bag.write(name + kHeaderSuffix, now, header);
  }
  bag.close();
}

}  // namespace relative_map
