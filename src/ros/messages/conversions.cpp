#include "relative_map/ros/messages/conversions.hpp"

#include <boost/make_shared.hpp>
#include <cmath>
#include <initializer_list>
#include <limits>

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map {

namespace {

using core::Point2;

Eigen::Vector3d to_core(const geometry_msgs::Point& p) {
  return {p.x, p.y, p.z};
}
Eigen::Vector3d to_core(const geometry_msgs::Vector3& v) {
  return {v.x, v.y, v.z};
}

ros::Time stamp_or(const ros::Time& stamp, const ros::Time& received) {
  return stamp.isZero() ? received : stamp;
}

core::BoundaryType boundary_type(uint8_t number) {
  return number <= LaneMarker::CURB ? static_cast<core::BoundaryType>(number) : core::BoundaryType::kUnknown;
}

core::LaneMarker to_core(const LaneMarker& message) {
  core::LaneMarker marker;
  marker.type = boundary_type(message.lane_type);
  marker.quality = message.quality;
  marker.cubic = {message.c0_position, message.c1_heading_angle, message.c2_curvature,
                  message.c3_curvature_derivative};
  marker.longitude_start = message.longitude_start;
  marker.view_range = message.view_range;
  return marker;
}

geometry_msgs::Point to_message(const Point2& point) {
  geometry_msgs::Point message;
  message.x = point.x();
  message.y = point.y();
  return message;
}

/// One segment that holds the whole curve; `position` takes a point of `points` to its place.
template <class Points, class Position>
Curve make_curve(const Points& points, double length, Position position) {
  Curve curve;
  curve.segment.resize(1);
  CurveSegment& segment = curve.segment[0];
  segment.line_segment.point.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i)
    segment.line_segment.point[i] = to_message(position(points[i]));
  segment.start_position = segment.line_segment.point.front();
  segment.length = length;
  const Point2 chord = position(points[1]) - position(points[0]);
  segment.heading = std::atan2(chord.y(), chord.x());
  return curve;
}

Curve make_curve(const core::Polyline& points, double length) {
  return make_curve(points, length, [](const Point2& point) { return point; });
}

LaneBoundary to_message(const core::LaneBoundary& boundary) {
  LaneBoundary message;
  message.curve = make_curve(boundary.points, boundary.length);
  message.length = boundary.length;
  message.is_virtual = boundary.is_virtual;
  for (const core::PaintSpan& span : boundary.paint) {
    LaneBoundaryType type;
    type.s = span.s;
    type.types.push_back(static_cast<uint8_t>(span.type));
    message.boundary_type.push_back(type);
  }
  return message;
}

std::vector<LaneSampleAssociation> to_message(const std::vector<core::WidthSample>& samples) {
  std::vector<LaneSampleAssociation> message(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    message[i].s = samples[i].s;
    message[i].width = samples[i].width;
  }
  return message;
}

void fill(const core::Lane& lane, Lane& message) {
  message.id = lane.id;
  message.central_curve =
      make_curve(lane.path, lane.length, [](const core::PathPoint& point) { return point.position; });
  message.central_curve.segment[0].heading = lane.path.front().theta;
  message.left_boundary = to_message(lane.left_boundary);
  message.right_boundary = to_message(lane.right_boundary);
  message.length = lane.length;
  message.speed_limit = lane.speed_limit;
  if (!lane.left_neighbor_id.empty()) message.left_neighbor_forward_lane_id.push_back(lane.left_neighbor_id);
  if (!lane.right_neighbor_id.empty())
    message.right_neighbor_forward_lane_id.push_back(lane.right_neighbor_id);
  message.type = Lane::CITY_DRIVING;
  message.turn = Lane::NO_TURN;
  message.direction = Lane::FORWARD;
  message.left_sample = to_message(lane.left_samples);
  message.right_sample = to_message(lane.right_samples);
  message.left_road_sample = to_message(lane.left_road_samples);
  message.right_road_sample = to_message(lane.right_road_samples);
}

/// [m] Where along a path the vehicle, at the origin, is beside it.
double s_of_vehicle(const core::PathPoints& points) {
  core::LanePath path;
  path.points = points;
  core::locate_vehicle(path);
  return path.s_at_vehicle;
}

/// [1/m^3] The derivative of dkappa by s, between the neighbours of a point.
double rate_of_dkappa(const core::PathPoints& path, std::size_t i) {
  const core::PathPoint& before = path[i > 0 ? i - 1 : i];
  const core::PathPoint& after = path[i + 1 < path.size() ? i + 1 : i];
  return (after.dkappa - before.dkappa) / (after.s - before.s);
}

void fill(const core::Lane& lane, LaneNavigationPath& message) {
  message.lane_id = lane.id;
  message.remaining_distance = lane.remaining_distance;
  message.vehicle_s = s_of_vehicle(lane.path);
  message.navigation_path.path_priority = lane.priority;
  message.navigation_path.path.name = lane.name;
  std::vector<PathPoint>& points = message.navigation_path.path.path_point;
  points.resize(lane.path.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const core::PathPoint& from = lane.path[i];
    PathPoint& to = points[i];
    to.x = from.position.x();
    to.y = from.position.y();
    to.theta = from.theta;
    to.kappa = from.kappa;
    to.dkappa = from.dkappa;
    to.ddkappa = rate_of_dkappa(lane.path, i);
    to.s = from.s;
  }
}

BoundaryEdge make_edge(const core::Polyline& points, uint8_t type) {
  BoundaryEdge edge;
  edge.curve = make_curve(points, core::chord_length(points));
  edge.type = type;
  return edge;
}

Road to_message(const core::Road& road) {
  Road message;
  message.id = road.id;
  message.type = Road::UNKNOWN;
  RoadSection section;
  section.id = road.id + "_section";
  section.lane_id = road.lane_ids;
  section.boundary.outer_polygon.edge = {make_edge(road.left_edge, BoundaryEdge::LEFT_BOUNDARY),
                                         make_edge(road.right_edge, BoundaryEdge::RIGHT_BOUNDARY)};
  message.section.push_back(std::move(section));
  return message;
}

FusionState to_message(const core::FusionState& fusion) {
  FusionState message;
  message.source = static_cast<uint8_t>(fusion.source);
  message.method = fusion.method;
  message.lateral_offset = fusion.lateral_offset.value;
  message.lateral_offset_stddev = fusion.lateral_offset.stddev;
  message.longitudinal_offset = fusion.longitudinal_offset.value;
  message.longitudinal_offset_stddev = fusion.longitudinal_offset.stddev;
  message.heading_offset = fusion.heading_offset.value;
  message.heading_offset_stddev = fusion.heading_offset.stddev;
  message.left_half_width = fusion.left_half_width.value;
  message.left_half_width_stddev = fusion.left_half_width.stddev;
  message.right_half_width = fusion.right_half_width.value;
  message.right_half_width_stddev = fusion.right_half_width.stddev;
  message.marker_range = fusion.marker_range;
  message.marker_age = fusion.marker_age;
  return message;
}

/// The greatest of those that are given; NaN if none is.
double given_stddev(std::initializer_list<double> values) {
  double greatest = std::numeric_limits<double>::quiet_NaN();
  for (const double value : values) {
    if (std::isfinite(value) && value > 0.0) greatest = std::fmax(greatest, value);
  }
  return greatest;
}

/// Map <- RFU is map <- FLU turned left: the RFU frame's y is FLU's x.
void turn_rfu_to_flu(core::Localization& localization) {
  const Eigen::Quaterniond rfu_from_flu(Eigen::AngleAxisd(core::kPi / 2.0, Eigen::Vector3d::UnitZ()));
  localization.map_from_body = localization.map_from_body * rfu_from_flu;
  localization.angular_velocity_body = rfu_from_flu.inverse() * localization.angular_velocity_body;
}

}  // namespace

core::Time to_core(const ros::Time& time) {
  return core::Time(std::chrono::seconds(time.sec) + std::chrono::nanoseconds(time.nsec));
}

ros::Time to_ros(core::Time time) {
  ros::Time result;
  const core::Duration since_epoch = time.time_since_epoch();
  if (since_epoch > core::Duration::zero()) result.fromNSec(static_cast<uint64_t>(since_epoch.count()));
  return result;
}

core::NavigationInfo to_core(const NavigationInfo& message) {
  core::NavigationInfo info;
  info.frame_id = frame_name(message.header.frame_id);
  for (const NavigationPath& path : message.navigation_path) {
    core::RecordedLine line;
    line.name = path.path.name;
    line.priority = path.path_priority;
    line.points.reserve(path.path.path_point.size());
    for (const PathPoint& p : path.path.path_point) {
      line.points.push_back({p.x, p.y, p.z, p.theta, p.kappa, p.dkappa, p.s});
    }
    info.lines.push_back(std::move(line));
  }
  return info;
}

NavigationInfo to_message(const core::NavigationInfo& info) {
  NavigationInfo message;
  message.header.frame_id = info.frame_id;
  for (const core::RecordedLine& line : info.lines) {
    NavigationPath path;
    path.path.name = line.name;
    path.path_priority = line.priority;
    path.path.path_point.reserve(line.points.size());
    for (const core::LinePoint& p : line.points) {
      PathPoint point;
      point.x = p.x;
      point.y = p.y;
      point.z = p.z;
      point.theta = p.theta;
      point.kappa = p.kappa;
      point.dkappa = p.dkappa;
      point.s = p.s;
      path.path.path_point.push_back(point);
    }
    message.navigation_path.push_back(std::move(path));
  }
  return message;
}

core::Chassis to_core(const Chassis& message, const ros::Time& received) {
  core::Chassis chassis;
  chassis.stamp = to_core(stamp_or(message.header.stamp, received));
  const uint8_t gear = message.gear_location;
  const bool reverse = gear == Chassis::GEAR_REVERSE;
  chassis.sign_known =
      reverse || gear == Chassis::GEAR_DRIVE || gear == Chassis::GEAR_LOW || message.speed_mps < 0.0;
  chassis.speed = reverse ? -std::abs(message.speed_mps) : message.speed_mps;
  return chassis;
}

core::Localization to_core(const LocalizationEstimate& message, OrientationConvention convention,
                           const ros::Time& received) {
  core::Localization localization;
  localization.stamp = to_core(stamp_or(message.header.stamp, received));
  localization.position = to_core(message.pose.position);
  const geometry_msgs::Quaternion& q = message.pose.orientation;
  localization.map_from_body = Eigen::Quaterniond(q.w, q.x, q.y, q.z);
  localization.heading = message.pose.heading;
  localization.linear_velocity = to_core(message.pose.linear_velocity);
  localization.angular_velocity_body = to_core(message.pose.angular_velocity_vrf);
  const geometry_msgs::Vector3& of_position = message.uncertainty.position_std_dev;
  localization.position_stddev = given_stddev({of_position.x, of_position.y});
  localization.heading_stddev = given_stddev({message.uncertainty.orientation_std_dev.z});
  if (message.status.code == LocalizationStatus::ERROR) localization.failure = message.status.message;
  if (convention == OrientationConvention::kRfu) turn_rfu_to_flu(localization);
  return localization;
}

core::LaneMarkers to_core(const LaneMarkers& message, const core::Pose2& base_from_sensor,
                          const ros::Time& received) {
  core::LaneMarkers markers;
  markers.stamp = to_core(stamp_or(message.header.stamp, received));
  markers.base_from_sensor = base_from_sensor;
  markers.left = to_core(message.left_lane_marker);
  markers.right = to_core(message.right_lane_marker);
  for (const LaneMarker& next : message.next_left_lane_marker) markers.next_left.push_back(to_core(next));
  for (const LaneMarker& next : message.next_right_lane_marker) markers.next_right.push_back(to_core(next));
  return markers;
}

MapMsgPtr to_message(const core::RelativeMap& map) {
  const MapMsgPtr message = boost::make_shared<MapMsg>();
  message->header.stamp = to_ros(map.stamp);
  message->header.frame_id = map.frame_id;
  message->sequence_num = map.sequence_num;
  message->status.code = static_cast<uint8_t>(map.status.code);
  message->status.message = map.status.message;
  message->hdmap.lane.resize(map.lanes.size());
  message->navigation_path.resize(map.lanes.size());
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    fill(map.lanes[i], message->hdmap.lane[i]);
    fill(map.lanes[i], message->navigation_path[i]);
  }
  for (const core::Road& road : map.roads) message->hdmap.road.push_back(to_message(road));
  message->current_lane_id = map.current_lane_id;
  message->fusion = to_message(map.fusion);
  return message;
}

std::string frame_name(const std::string& frame_id) {
  return !frame_id.empty() && frame_id.front() == '/' ? frame_id.substr(1) : frame_id;
}

}  // namespace relative_map
