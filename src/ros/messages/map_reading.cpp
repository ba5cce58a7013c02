// The way back from a published map to the core's structs, for checks of what was really sent.
#include <algorithm>
#include <cmath>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

core::Polyline points_of(const Curve& curve) {
  core::Polyline points;
  for (const CurveSegment& segment : curve.segment) {
    for (const geometry_msgs::Point& point : segment.line_segment.point)
      points.emplace_back(point.x, point.y);
  }
  return points;
}

core::PathPoints path_of(const LaneNavigationPath& path) {
  core::PathPoints points;
  for (const PathPoint& from : path.navigation_path.path.path_point) {
    core::PathPoint point;
    point.position = {from.x, from.y};
    point.theta = from.theta;
    point.direction = {std::cos(from.theta), std::sin(from.theta)};
    point.kappa = from.kappa;
    point.dkappa = from.dkappa;
    point.s = from.s;
    points.push_back(point);
  }
  return points;
}

core::LaneBoundary boundary_of(const LaneBoundary& message) {
  core::LaneBoundary boundary;
  boundary.points = points_of(message.curve);
  boundary.length = message.length;
  boundary.is_virtual = message.is_virtual;
  for (const LaneBoundaryType& type : message.boundary_type) {
    core::PaintSpan span{type.s, core::BoundaryType::kUnknown};
    if (!type.types.empty()) span.type = static_cast<core::BoundaryType>(type.types.front());
    boundary.paint.push_back(span);
  }
  return boundary;
}

std::vector<core::WidthSample> samples_of(const std::vector<LaneSampleAssociation>& message) {
  std::vector<core::WidthSample> samples;
  for (const LaneSampleAssociation& sample : message) samples.push_back({sample.s, sample.width});
  return samples;
}

core::Lane lane_of(const Lane& message, const MapMsg& map) {
  core::Lane lane;
  lane.id = message.id;
  const auto path = std::find_if(map.navigation_path.begin(), map.navigation_path.end(),
                                 [&](const LaneNavigationPath& p) { return p.lane_id == message.id; });
  if (path != map.navigation_path.end()) {
    lane.name = path->navigation_path.path.name;
    lane.priority = path->navigation_path.path_priority;
    lane.remaining_distance = path->remaining_distance;
    lane.path = path_of(*path);
  }
  lane.length = message.length;
  lane.speed_limit = message.speed_limit;
  lane.left_boundary = boundary_of(message.left_boundary);
  lane.right_boundary = boundary_of(message.right_boundary);
  lane.left_samples = samples_of(message.left_sample);
  lane.right_samples = samples_of(message.right_sample);
  lane.left_road_samples = samples_of(message.left_road_sample);
  lane.right_road_samples = samples_of(message.right_road_sample);
  if (!message.left_neighbor_forward_lane_id.empty()) {
    lane.left_neighbor_id = message.left_neighbor_forward_lane_id.front();
  }
  if (!message.right_neighbor_forward_lane_id.empty()) {
    lane.right_neighbor_id = message.right_neighbor_forward_lane_id.front();
  }
  return lane;
}

core::Road road_of(const Road& message) {
  core::Road road;
  road.id = message.id;
  for (const RoadSection& section : message.section) {
    road.lane_ids.insert(road.lane_ids.end(), section.lane_id.begin(), section.lane_id.end());
    for (const BoundaryEdge& edge : section.boundary.outer_polygon.edge) {
      if (edge.type == BoundaryEdge::LEFT_BOUNDARY) road.left_edge = points_of(edge.curve);
      if (edge.type == BoundaryEdge::RIGHT_BOUNDARY) road.right_edge = points_of(edge.curve);
    }
  }
  return road;
}

core::FusionState fusion_of(const FusionState& message) {
  core::FusionState fusion;
  fusion.source = static_cast<core::Source>(message.source);
  fusion.method = message.method;
  fusion.lateral_offset = {message.lateral_offset, message.lateral_offset_stddev};
  fusion.longitudinal_offset = {message.longitudinal_offset, message.longitudinal_offset_stddev};
  fusion.heading_offset = {message.heading_offset, message.heading_offset_stddev};
  fusion.left_half_width = {message.left_half_width, message.left_half_width_stddev};
  fusion.right_half_width = {message.right_half_width, message.right_half_width_stddev};
  fusion.marker_range = message.marker_range;
  fusion.marker_age = message.marker_age;
  return fusion;
}

}  // namespace

core::RelativeMap to_core(const MapMsg& message) {
  core::RelativeMap map;
  map.stamp = to_core(message.header.stamp);
  map.frame_id = message.header.frame_id;
  map.sequence_num = message.sequence_num;
  map.status = {static_cast<core::StatusCode>(message.status.code), message.status.message};
  for (const Lane& lane : message.hdmap.lane) map.lanes.push_back(lane_of(lane, message));
  for (const Road& road : message.hdmap.road) map.roads.push_back(road_of(road));
  map.current_lane_id = message.current_lane_id;
  map.fusion = fusion_of(message.fusion);
  return map;
}

}  // namespace relative_map
