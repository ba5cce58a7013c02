#include "navigation_line_bag.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <nav_msgs/Path.h>
#include <relative_map/LocalizationEstimate.h>
#include <rosbag/view.h>
#include <sensor_msgs/NavSatFix.h>
#include <std_msgs/String.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <set>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"
#include "relative_map/ros/conversions.hpp"

namespace relative_map {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr const char* kDefaultTopic = "/navigation_line";
constexpr const char* kHeaderSuffix = "_header";

/// NaN where there is no orientation.
double yaw_of(const geometry_msgs::Quaternion& q) {
  const double norm = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  if (!(norm > 0.5)) return kNaN;
  return std::atan2(2.0 * (q.w * q.z + q.x * q.y), norm - 2.0 * (q.y * q.y + q.z * q.z));
}

core::RecordedPose make_pose(const ros::Time& stamp, const geometry_msgs::Point& position, double heading) {
  return {stamp.toSec(), position.x, position.y, position.z, heading};
}

std::map<std::string, std::string> topics_of(const rosbag::Bag& bag) {
  std::map<std::string, std::string> topics;
  for (const rosbag::ConnectionInfo* connection : rosbag::View(bag).getConnections()) {
    topics[connection->topic] = connection->datatype;
  }
  return topics;
}

std::string listed(const std::map<std::string, std::string>& topics) {
  std::string list;
  for (const auto& [topic, type] : topics) list += (list.empty() ? "" : ", ") + topic + " (" + type + ")";
  return list.empty() ? "nothing" : list;
}

}  // namespace

void open_bag(const std::string& path, rosbag::Bag& bag) {
  try {
    bag.open(path, rosbag::bagmode::Read);
  } catch (const rosbag::BagUnindexedException&) {
    throw std::runtime_error(path + ": is cut off, and has no index: run rosbag reindex on it");
  } catch (const rosbag::BagException& fault) {
    throw std::runtime_error(path + ": not a readable bag: " + fault.what());
  }
}

std::string find_topic(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                       const std::vector<std::string>& types) {
  const std::map<std::string, std::string> all = topics_of(bag);
  std::map<std::string, std::string> fitting;
  for (const auto& [name, type] : all) {
    if (std::find(types.begin(), types.end(), type) != types.end()) fitting[name] = type;
  }
  if (!topic.empty()) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& entry) {
      return frame_name(entry.first) == frame_name(topic);
    });
    if (found == all.end())
      throw std::runtime_error(path + ": has no topic " + topic + "; it has " + listed(all));
    if (fitting.count(found->first) == 0) {
      throw std::runtime_error(path + ": " + found->first + " is of type " + found->second +
                               ", which is not one of " + "those that are read here");
    }
    return found->first;
  }
  if (fitting.empty()) {
    std::string wanted;
    for (const std::string& type : types) wanted += (wanted.empty() ? "" : ", ") + type;
    throw std::runtime_error(path + ": has no topic of " + wanted + "; it has " + listed(all));
  }
  if (fitting.size() > 1)
    throw std::runtime_error(path + ": name one of its topics by --topic: " + listed(fitting));
  return fitting.begin()->first;
}

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
        file.header.reference = core::parse_line_header(header->data).reference;
      }
    }
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ": cannot be read: " + fault.what());
  }
  if (file.line.points.empty()) throw std::runtime_error(path + ": has no points");
  return file;
}

void write_path_bag(const std::string& path, const std::string& topic, const core::LineFile& file) {
  core::expect_finite_positions(path, file.line);
  const std::string name = topic.empty() ? kDefaultTopic : topic;
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
  const std::string temporary = core::temporary_name(path);
  const ros::Time now(ros::WallTime::now().toSec());
  auto bag = std::make_unique<rosbag::Bag>();
  try {
    bag->open(temporary, rosbag::bagmode::Write);
    bag->write(name, now, message);
    if (!core::is_empty(file.header)) {
      std_msgs::String header;
      header.data = core::to_json(file.header);
      bag->write(name + kHeaderSuffix, now, header);
    }
    bag->close();
  } catch (const std::exception& fault) {
    static_cast<void>(bag.release());  // on a full disk its destructor writes once more, and throws
    std::remove(temporary.c_str());
    throw std::runtime_error("cannot write " + path + ": " + fault.what());
  }
  core::move_into_place(temporary, path);
}

const std::vector<std::string>& PoseCollector::types() {
  static const std::vector<std::string> kTypes = {"relative_map/LocalizationEstimate", "nav_msgs/Odometry",
                                                  "geometry_msgs/PoseStamped", "sensor_msgs/NavSatFix"};
  return kTypes;
}

void PoseCollector::note_frame(const std::string& frame) {
  const std::string name = frame_name(frame);
  if (has_frame_ && name != frame_) {
    throw std::runtime_error("the poses change from frame '" + frame_ + "' to '" + name + "'");
  }
  frame_ = name;
  has_frame_ = true;
}

template <>
void PoseCollector::add(const LocalizationEstimate& message) {
  note_frame(message.header.frame_id);
  const double heading =
      std::isfinite(message.pose.heading) ? message.pose.heading : yaw_of(message.pose.orientation);
  poses_.push_back(make_pose(message.header.stamp, message.pose.position, heading));
}

template <>
void PoseCollector::add(const nav_msgs::Odometry& message) {
  note_frame(message.header.frame_id);
  poses_.push_back(
      make_pose(message.header.stamp, message.pose.pose.position, yaw_of(message.pose.pose.orientation)));
}

template <>
void PoseCollector::add(const geometry_msgs::PoseStamped& message) {
  note_frame(message.header.frame_id);
  poses_.push_back(make_pose(message.header.stamp, message.pose.position, yaw_of(message.pose.orientation)));
}

template <>
void PoseCollector::add(const sensor_msgs::NavSatFix& message) {
  const bool fix = message.status.status >= sensor_msgs::NavSatStatus::STATUS_FIX &&
                   std::isfinite(message.latitude) && std::isfinite(message.longitude);
  if (!fix) {
    ++without_fix_;
    return;
  }
  places_.push_back({message.longitude, message.latitude, message.altitude});
  stamps_.push_back(message.header.stamp.toSec());
}

std::vector<core::RecordedPose> PoseCollector::poses(core::GeoReference& reference) const {
  std::vector<core::RecordedPose> poses = poses_;
  if (geographic()) {
    if (reference.projection == core::Projection::kNone) reference = core::utm_zone_of(places_);
    const std::vector<core::LinePoint> points = core::project(places_, reference);
    for (std::size_t i = 0; i < points.size(); ++i) {
      poses.push_back({stamps_[i], points[i].x, points[i].y, points[i].z, kNaN});
    }
  }
  std::stable_sort(poses.begin(), poses.end(), [](const core::RecordedPose& a, const core::RecordedPose& b) {
    return a.stamp < b.stamp;
  });
  return poses;
}

void read_poses(const std::string& path, const std::string& topic, PoseCollector& poses,
                const std::function<void(double)>& progress) {
  rosbag::Bag bag;
  open_bag(path, bag);
  const std::string name = find_topic(bag, path, topic, PoseCollector::types());
  try {
    rosbag::View view(bag, rosbag::TopicQuery(name));
    std::size_t done = 0;
    for (const rosbag::MessageInstance& instance : view) {
      progress(static_cast<double>(++done) / static_cast<double>(view.size()));
      if (const auto localization = instance.instantiate<LocalizationEstimate>()) {
        poses.add(*localization);
      } else if (const auto odometry = instance.instantiate<nav_msgs::Odometry>()) {
        poses.add(*odometry);
      } else if (const auto pose = instance.instantiate<geometry_msgs::PoseStamped>()) {
        poses.add(*pose);
      } else if (const auto fix = instance.instantiate<sensor_msgs::NavSatFix>()) {
        poses.add(*fix);
      } else {
        throw std::runtime_error(instance.getDataType() + " is of another definition than here");
      }
    }
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ", topic " + name + ": " + fault.what());
  }
}

}  // namespace relative_map
