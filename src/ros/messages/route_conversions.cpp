#include "relative_map/ros/messages/route_conversions.hpp"

#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>

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

Curve curve_of(const core::Polyline& points) {
  Curve curve;
  curve.segment.resize(1);
  for (const core::Point2& point : points) {
    geometry_msgs::Point to;
    to.x = point.x();
    to.y = point.y();
    curve.segment[0].line_segment.point.push_back(to);
  }
  curve.segment[0].length = core::chord_length(points);
  if (!points.empty()) curve.segment[0].start_position = curve.segment[0].line_segment.point.front();
  return curve;
}

/// Of several kinds of paint at one place the one that must not be crossed counts.
core::BoundaryType strictest(const std::vector<uint8_t>& types) {
  core::BoundaryType strictest = core::BoundaryType::kUnknown;
  for (const uint8_t number : types) {
    const core::BoundaryType type = number <= LaneBoundaryType::CURB ? static_cast<core::BoundaryType>(number)
                                                                     : core::BoundaryType::kUnknown;
    if (type > strictest) strictest = type;
  }
  return strictest;
}

std::vector<core::PaintSpan> paint_of(const LaneBoundary& boundary) {
  std::vector<core::PaintSpan> spans;
  for (const LaneBoundaryType& type : boundary.boundary_type)
    spans.push_back({type.s, strictest(type.types)});
  return spans;
}

std::vector<LaneBoundaryType> paint_message(const std::vector<core::PaintSpan>& spans) {
  std::vector<LaneBoundaryType> types(spans.size());
  for (std::size_t i = 0; i < spans.size(); ++i) {
    types[i].s = spans[i].s;
    types[i].types = {static_cast<uint8_t>(spans[i].type)};
  }
  return types;
}

std::vector<core::WidthSample> samples_of(const std::vector<LaneSampleAssociation>& message) {
  std::vector<core::WidthSample> samples;
  for (const LaneSampleAssociation& sample : message) samples.push_back({sample.s, sample.width});
  return samples;
}

std::vector<LaneSampleAssociation> samples_message(const std::vector<core::WidthSample>& samples) {
  std::vector<LaneSampleAssociation> message(samples.size());
  for (std::size_t i = 0; i < samples.size(); ++i) {
    message[i].s = samples[i].s;
    message[i].width = samples[i].width;
  }
  return message;
}

template <class Enum>
Enum enum_of(uint8_t number, Enum last) {
  return number <= static_cast<uint8_t>(last) ? static_cast<Enum>(number) : Enum{};
}

std::vector<RouteLaneSegment> pieces_message(const std::vector<core::LaneSegment>& segments) {
  std::vector<RouteLaneSegment> message(segments.size());
  for (std::size_t i = 0; i < segments.size(); ++i) {
    message[i].lane_id = segments[i].lane_id;
    message[i].start_s = segments[i].start_s;
    message[i].end_s = segments[i].end_s;
  }
  return message;
}

void fill_line(const core::ReferenceLine& line, RouteSegments& message) {
  message.path.name = line.id;
  message.s = line.s;
  for (const core::ReferencePoint& point : line.points) {
    PathPoint to;
    to.x = point.path.position.x();
    to.y = point.path.position.y();
    to.theta = point.path.theta;
    to.kappa = point.path.kappa;
    to.dkappa = point.path.dkappa;
    to.s = point.path.s;
    message.path.path_point.push_back(to);
    message.speed_limit.push_back(point.speed_limit);
  }
}

}  // namespace

core::LaneGraph to_core(const LaneGraph& message) {
  core::LaneGraph graph;
  graph.frame_id = frame_name(message.header.frame_id);
  graph.map_version = message.map_version;
  for (const Lane& from : message.lane) {
    core::GraphLane lane;
    lane.id = from.id;
    lane.centerline = points_of(from.central_curve);
    lane.left_width = samples_of(from.left_sample);
    lane.right_width = samples_of(from.right_sample);
    lane.successors = from.successor_id;
    lane.predecessors = from.predecessor_id;
    lane.left_neighbors = from.left_neighbor_forward_lane_id;
    lane.right_neighbors = from.right_neighbor_forward_lane_id;
    lane.left_reverse = from.left_neighbor_reverse_lane_id;
    lane.right_reverse = from.right_neighbor_reverse_lane_id;
    lane.left_paint = paint_of(from.left_boundary);
    lane.right_paint = paint_of(from.right_boundary);
    lane.speed_limit = from.speed_limit;
    lane.type = enum_of(from.type, core::LaneType::kShoulder);
    lane.turn = enum_of(from.turn, core::LaneTurn::kUTurn);
    lane.junction = from.junction_id;
    graph.lanes.push_back(std::move(lane));
  }
  return graph;
}

LaneGraph to_message(const core::LaneGraph& graph) {
  LaneGraph message;
  message.header.frame_id = graph.frame_id;
  message.map_version = graph.map_version;
  for (const core::GraphLane& lane : graph.lanes) {
    Lane to;
    to.id = lane.id;
    to.central_curve = curve_of(lane.centerline);
    to.length = core::chord_length(lane.centerline);
    to.left_sample = samples_message(lane.left_width);
    to.right_sample = samples_message(lane.right_width);
    to.successor_id = lane.successors;
    to.predecessor_id = lane.predecessors;
    to.left_neighbor_forward_lane_id = lane.left_neighbors;
    to.right_neighbor_forward_lane_id = lane.right_neighbors;
    to.left_neighbor_reverse_lane_id = lane.left_reverse;
    to.right_neighbor_reverse_lane_id = lane.right_reverse;
    to.left_boundary.boundary_type = paint_message(lane.left_paint);
    to.right_boundary.boundary_type = paint_message(lane.right_paint);
    to.speed_limit = lane.speed_limit;
    to.type = static_cast<uint8_t>(lane.type);
    to.turn = static_cast<uint8_t>(lane.turn);
    to.direction = Lane::FORWARD;
    to.junction_id = lane.junction;
    message.lane.push_back(std::move(to));
  }
  return message;
}

core::Route to_core(const Route& message) {
  core::Route route;
  route.id = message.id;
  route.frame_id = frame_name(message.header.frame_id);
  route.map_version = message.map_version;
  route.distance = message.distance;
  for (const RouteRoad& from : message.road) {
    core::RouteRoad road;
    road.id = from.id;
    for (const RoutePassage& passage : from.passage) {
      core::Passage to;
      to.can_exit = passage.can_exit;
      to.change_lane = enum_of(passage.change_lane_type, core::ChangeLane::kRight);
      for (const RouteLaneSegment& segment : passage.segment) {
        to.segments.push_back({segment.lane_id, segment.start_s, segment.end_s});
      }
      road.passages.push_back(std::move(to));
    }
    route.roads.push_back(std::move(road));
  }
  for (const RouteWaypoint& waypoint : message.waypoint) {
    route.waypoints.push_back({waypoint.lane_id, waypoint.s, core::Point2(waypoint.pose.x, waypoint.pose.y)});
  }
  return route;
}

Route to_message(const core::Route& route) {
  Route message;
  message.id = route.id;
  message.header.frame_id = route.frame_id;
  message.map_version = route.map_version;
  message.distance = route.distance;
  for (const core::RouteRoad& from : route.roads) {
    RouteRoad road;
    road.id = from.id;
    for (const core::Passage& passage : from.passages) {
      RoutePassage to;
      to.segment = pieces_message(passage.segments);
      to.can_exit = passage.can_exit;
      to.change_lane_type = static_cast<uint8_t>(passage.change_lane);
      road.passage.push_back(std::move(to));
    }
    message.road.push_back(std::move(road));
  }
  for (const core::RouteWaypoint& from : route.waypoints) {
    RouteWaypoint waypoint;
    waypoint.lane_id = from.lane_id;
    waypoint.s = from.s;
    waypoint.heading = std::numeric_limits<double>::quiet_NaN();
    if (from.position) {
      waypoint.pose.x = from.position->x();
      waypoint.pose.y = from.position->y();
    }
    message.waypoint.push_back(waypoint);
  }
  return message;
}

LaneChange to_message(const core::LaneChangeStatus& status) {
  LaneChange message;
  message.header.stamp = ros::Time(status.time);
  message.state = static_cast<uint8_t>(status.state);
  message.from_lane = status.from_lane;
  message.to_lane = status.to_lane;
  message.side = static_cast<uint8_t>(status.side);
  message.message = status.message;
  return message;
}

std::string sentence_of(const core::LaneChangeStatus& status) {
  static const char* const kNames[] = {"none", "changing", "done", "timed out", "abandoned"};
  return "to lane '" + status.to_lane + "': " + kNames[static_cast<std::size_t>(status.state)] +
         (status.message.empty() ? "" : ": " + status.message);
}

RouteSegmentsArrayPtr to_message(const core::RouteUpdate& update,
                                 const std::vector<core::ReferenceLine>& lines) {
  auto message = boost::make_shared<RouteSegmentsArray>();
  message->status.code = static_cast<uint8_t>(update.status.code);
  message->status.message = update.status.message;
  if (update.place) {
    message->lane_id = update.place->lane_id;
    message->s = update.place->s;
    message->l = update.place->l;
    message->next_waypoint = static_cast<uint32_t>(update.place->next_waypoint);
    message->distance_to_destination = update.place->distance_to_destination;
  }
  for (std::size_t i = 0; i < update.segments.size(); ++i) {
    const core::RouteSegments& from = update.segments[i];
    RouteSegments to;
    to.id = from.id;
    to.segment = pieces_message(from.segments);
    to.is_on_segment = from.is_on_segment;
    to.is_neighbor = from.is_neighbor;
    to.next_action = static_cast<uint8_t>(from.next_action);
    to.previous_action = static_cast<uint8_t>(from.previous_action);
    to.can_exit = from.can_exit;
    to.stop_for_destination = from.stop_for_destination;
    to.has_route_end = from.route_end.has_value();
    to.route_end.heading = std::numeric_limits<double>::quiet_NaN();
    if (from.route_end) {
      to.route_end.lane_id = from.route_end->lane_id;
      to.route_end.s = from.route_end->s;
    }
    to.has_change = from.change.has_value();
    if (from.change) {
      to.change_begin = from.change->begin;
      to.change_end = from.change->end;
    }
    to.priority = from.priority;
    to.s = from.s;
    if (i < lines.size()) fill_line(lines[i], to);
    message->segments.push_back(std::move(to));
  }
  return message;
}

nav_msgs::Path to_path(const RouteSegments& segments, const std_msgs::Header& header) {
  nav_msgs::Path path;
  path.header = header;
  for (const PathPoint& point : segments.path.path_point) {
    geometry_msgs::PoseStamped pose;
    pose.header = header;
    pose.pose.position.x = point.x;
    pose.pose.position.y = point.y;
    pose.pose.orientation.z = std::sin(point.theta / 2.0);
    pose.pose.orientation.w = std::cos(point.theta / 2.0);
    path.poses.push_back(pose);
  }
  return path;
}

std::string route_status_name(core::RouteCode code) {
  constexpr const char* kNames[] = {"OK",
                                    "NO_GRAPH",
                                    "NO_ROUTE",
                                    "UNKNOWN_LANE",
                                    "BAD_WAYPOINT",
                                    "NO_LOCALIZATION",
                                    "STALE_LOCALIZATION",
                                    "OFF_ROUTE",
                                    "WRONG_WAY",
                                    "ROUTE_END",
                                    "FRAME_MISMATCH",
                                    "CONTRACT_VIOLATION",
                                    "BAD_ROUTE",
                                    "BAD_GRAPH",
                                    "NO_MAP",
                                    "STALE_MAP"};
  return kNames[static_cast<std::size_t>(code)];
}

}  // namespace relative_map
