#pragma once

#include <relative_map/Chassis.h>
#include <relative_map/LaneMarkers.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/MapMsg.h>
#include <relative_map/NavigationInfo.h>

#include <Eigen/Geometry>
#include <boost/make_shared.hpp>
#include <string>
#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "support/lines.hpp"

// Messages as a vehicle sends them, for tests.
namespace relative_map::test {

using core::Point2;
using core::Pose2;
using core::test::kNaN;

constexpr double kLaneWidth = 3.5;  // [m] between the lines of `three_lanes`

inline Eigen::Quaterniond yaw(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

inline geometry_msgs::Quaternion quaternion(const Eigen::Quaterniond& q) {
  geometry_msgs::Quaternion message;
  message.w = q.w();
  message.x = q.x();
  message.y = q.y();
  message.z = q.z();
  return message;
}

template <class Message>
void set_xyz(Message& message, const Eigen::Vector3d& value) {
  message.x = value.x();
  message.y = value.y();
  message.z = value.z();
}

inline NavigationPath navigation_path(const core::Polyline& points, const std::string& name,
                                      uint32_t priority) {
  NavigationPath line;
  line.path.name = name;
  line.path_priority = priority;
  for (const Point2& position : points) {
    PathPoint point;
    point.x = position.x();
    point.y = position.y();
    point.z = point.theta = point.kappa = point.dkappa = point.s = kNaN;
    line.path.path_point.push_back(point);
  }
  return line;
}

/// Three lines side by side, each a point a metre from `start` straight on.
inline NavigationInfo three_lanes(const Pose2& start, double length = 400.0) {
  NavigationInfo info;
  info.header.frame_id = "map";
  const char* names[] = {"left", "middle", "right"};
  for (int i = 0; i < 3; ++i) {
    const Pose2 beside = start.to_parent(Pose2(Point2(0.0, kLaneWidth * (1 - i)), 0.0));
    const uint32_t priority = i == 1 ? 0 : static_cast<uint32_t>(i + 1);
    info.navigation_path.push_back(
        navigation_path(core::test::straight(beside, length, 1.0), names[i], priority));
  }
  return info;
}

/// base_link at `pose`, driving straight on at 10 m/s.
inline LocalizationEstimate localization(const Pose2& pose, const ros::Time& stamp) {
  LocalizationEstimate message;
  message.header.stamp = stamp;
  message.header.frame_id = "map";
  set_xyz(message.pose.position, {pose.position().x(), pose.position().y(), 0.0});
  message.pose.heading = pose.heading();
  message.pose.orientation = quaternion(yaw(pose.heading()));
  set_xyz(message.pose.linear_velocity, {10.0 * pose.forward().x(), 10.0 * pose.forward().y(), 0.0});
  return message;
}

inline LaneMarker lane_marker(double c0, uint8_t type = LaneMarker::SOLID_WHITE) {
  LaneMarker marker;
  marker.lane_type = type;
  marker.quality = 1.0;
  marker.model_degree = 3;
  marker.c0_position = c0;
  marker.view_range = 60.0;
  return marker;
}

/// The paint of a straight lane whose middle lies `offset` [m] to the left of the sensor.
inline LaneMarkers lane_markers(const ros::Time& stamp, double offset = 0.0,
                                const std::string& frame = "base_link") {
  LaneMarkers markers;
  markers.header.stamp = stamp;
  markers.header.frame_id = frame;
  markers.left_lane_marker = lane_marker(offset + 0.5 * kLaneWidth, LaneMarker::DOTTED_WHITE);
  markers.right_lane_marker = lane_marker(offset - 0.5 * kLaneWidth, LaneMarker::SOLID_WHITE);
  return markers;
}

template <class Message>
boost::shared_ptr<const Message> shared(const Message& message) {
  return boost::make_shared<const Message>(message);
}

}  // namespace relative_map::test
