#include "pose_collector.hpp"

#include <geometry_msgs/PoseStamped.h>
#include <nav_msgs/Odometry.h>
#include <relative_map/LocalizationEstimate.h>
#include <rosbag/view.h>
#include <sensor_msgs/NavSatFix.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

#include "bag_input.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

core::Time stamp_or(const ros::Time& stamp, const ros::Time& received) {
  return to_core(stamp.isZero() ? received : stamp);
}

core::Localization to_localization(const std_msgs::Header& header, const geometry_msgs::Pose& pose,
                                   const ros::Time& received) {
  core::Localization localization;
  localization.stamp = stamp_or(header.stamp, received);
  localization.position = {pose.position.x, pose.position.y, pose.position.z};
  const geometry_msgs::Quaternion& q = pose.orientation;
  localization.map_from_body = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  localization.heading = kNaN;
  return localization;
}

/// NaN where neither heading nor orientation gives it.
double heading_of(const core::Localization& checked) {
  if (std::isfinite(checked.heading)) return checked.heading;
  if (checked.map_from_body.coeffs().isZero()) return kNaN;
  const Eigen::Vector3d forward = checked.map_from_body * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

}  // namespace

const std::vector<std::string>& PoseCollector::types() {
  static const std::vector<std::string> kTypes = {"relative_map/LocalizationEstimate", "nav_msgs/Odometry",
                                                  "geometry_msgs/PoseStamped", "sensor_msgs/NavSatFix"};
  return kTypes;
}

PoseCollector::PoseCollector(std::string base_frame, OrientationConvention convention,
                             LinkTransforms transforms)
    : base_frame_(std::move(base_frame)), convention_(convention), transforms_(std::move(transforms)) {}

void PoseCollector::note_frame(const std::string& frame) {
  const std::string name = frame_name(frame);
  if (has_frame_ && name != frame_) {
    throw std::runtime_error("the poses change from frame '" + frame_ + "' to '" + name + "'");
  }
  frame_ = name;
  has_frame_ = true;
}

void PoseCollector::add_pose(const core::Localization& pose, const std::string& frame,
                             const std::string& link) {
  note_frame(frame);
  const std::string name = link.empty() ? base_frame_ : frame_name(link);
  if (name != base_frame_) links_.insert(name);
  poses_.push_back({pose, name});
}

template <>
void PoseCollector::add(const LocalizationEstimate& message, const ros::Time& received) {
  add_pose(to_core(message, convention_, received), message.header.frame_id, message.child_frame_id);
}

template <>
void PoseCollector::add(const nav_msgs::Odometry& message, const ros::Time& received) {
  add_pose(to_localization(message.header, message.pose.pose, received), message.header.frame_id,
           message.child_frame_id);
}

template <>
void PoseCollector::add(const geometry_msgs::PoseStamped& message, const ros::Time& received) {
  add_pose(to_localization(message.header, message.pose, received), message.header.frame_id, "");
}

template <>
void PoseCollector::add(const sensor_msgs::NavSatFix& message, const ros::Time& received) {
  const bool unset = message.latitude == 0.0 && message.longitude == 0.0;  // far out at sea
  const bool fix = message.status.status >= sensor_msgs::NavSatStatus::STATUS_FIX && !unset &&
                   std::isfinite(message.latitude) && std::isfinite(message.longitude);
  if (!fix) {
    ++without_fix_;
    return;
  }
  const std::string link = frame_name(message.header.frame_id);
  antenna_ = link == base_frame_ ? "" : link;
  places_.push_back({message.longitude, message.latitude, message.altitude});
  stamps_.push_back(core::to_seconds(stamp_or(message.header.stamp, received)));
}

std::string PoseCollector::missing_transform() const {
  for (const std::string& link : links_) {
    if (transforms_(link, base_frame_)) continue;
    return "its poses are of '" + link + "', and there is no transform from that to '" + base_frame_ +
           "' in /tf_static: record it, too, or name the frame that the line shall be of by --base-frame";
  }
  return "";
}

CarriedPoses PoseCollector::poses(core::GeoReference& reference) const {
  if (const std::string fault = missing_transform(); !fault.empty()) throw std::runtime_error(fault);
  CarriedPoses result;
  for (const LinkPose& entry : poses_) {
    const core::Checked<core::Localization> checked = core::check_localization(entry.pose);
    core::Localization pose = checked.input;
    double heading = checked.refusal ? kNaN : heading_of(pose);
    if (entry.link != base_frame_) {
      if (!std::isfinite(heading)) {
        ++result.without_direction;
        continue;
      }
      pose = core::carry_to_base(pose, *transforms_(entry.link, base_frame_));
      heading = pose.heading;
    }
    result.poses.push_back(
        {core::to_seconds(pose.stamp), pose.position.x(), pose.position.y(), pose.position.z(), heading});
  }
  if (geographic()) {
    if (reference.projection == core::Projection::kNone) reference = core::utm_zone_of(places_);
    const std::vector<core::LinePoint> points = core::project(places_, reference);
    for (std::size_t i = 0; i < points.size(); ++i) {
      result.poses.push_back({stamps_[i], points[i].x, points[i].y, points[i].z, kNaN});
    }
  }
  std::stable_sort(
      result.poses.begin(), result.poses.end(),
      [](const core::RecordedPose& a, const core::RecordedPose& b) { return a.stamp < b.stamp; });
  return result;
}

void read_poses(const rosbag::Bag& bag, const std::string& path, const std::string& topic,
                PoseCollector& poses, const std::function<void(double)>& progress) {
  const std::string name = find_topic(bag, path, topic, PoseCollector::types());
  try {
    rosbag::View view(bag, rosbag::TopicQuery(name));
    std::size_t done = 0;
    for (const rosbag::MessageInstance& instance : view) {
      progress(static_cast<double>(++done) / static_cast<double>(view.size()));
      const ros::Time received = instance.getTime();
      if (const auto localization = instance.instantiate<LocalizationEstimate>()) {
        poses.add(*localization, received);
      } else if (const auto odometry = instance.instantiate<nav_msgs::Odometry>()) {
        poses.add(*odometry, received);
      } else if (const auto pose = instance.instantiate<geometry_msgs::PoseStamped>()) {
        poses.add(*pose, received);
      } else if (const auto fix = instance.instantiate<sensor_msgs::NavSatFix>()) {
        poses.add(*fix, received);
      } else {
        throw std::runtime_error(instance.getDataType() + " is of another definition than here");
      }
    }
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ", topic " + name + ": " + fault.what());
  }
}

}  // namespace relative_map
