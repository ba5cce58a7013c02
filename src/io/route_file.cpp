#include "json_fields.hpp"
#include "relative_map/io/lane_graph_file.hpp"

namespace relative_map::core {

namespace {

using json_fields::Json;

constexpr const char* kChanges[] = {"FORWARD", "LEFT", "RIGHT"};

ChangeLane change_of(const std::string& name, const std::string& where) {
  for (std::size_t i = 0; i < std::size(kChanges); ++i) {
    if (name == kChanges[i]) return static_cast<ChangeLane>(i);
  }
  json_fields::fail(where, "'" + name + "' is no change_lane_type: FORWARD, LEFT, RIGHT");
}

LaneSegment segment_of(const Json& object, const std::string& where) {
  if (!object.is_object()) json_fields::fail(where, "must be an object");
  const auto number = [&](const char* key) {
    return json_fields::number(json_fields::required(object, key, where), where + " '" + key + "'");
  };
  LaneSegment segment;
  segment.lane_id = json_fields::text(json_fields::required(object, "id", where), where + " 'id'");
  segment.start_s = number("start_s");
  segment.end_s = number("end_s");
  return segment;
}

Passage passage_of(const Json& object, const std::string& where) {
  if (!object.is_object()) json_fields::fail(where, "must be an object");
  Passage passage;
  for (const Json& segment : json_fields::list(object, "segments", where)) {
    passage.segments.push_back(
        segment_of(segment, where + ", segment " + std::to_string(passage.segments.size())));
  }
  if (const Json* exit = json_fields::optional(object, "can_exit")) {
    if (!exit->is_boolean()) json_fields::fail(where, "'can_exit' must be true or false");
    passage.can_exit = exit->get<bool>();
  }
  passage.change_lane =
      change_of(json_fields::text_or(object, "change_lane_type", "FORWARD", where), where + ":");
  return passage;
}

RouteWaypoint waypoint_of(const Json& object, const std::string& where) {
  if (!object.is_object()) json_fields::fail(where, "must be an object");
  RouteWaypoint waypoint;
  waypoint.lane_id = json_fields::text(json_fields::required(object, "id", where), where + " 'id'");
  waypoint.s = json_fields::number(json_fields::required(object, "s", where), where + " 's'");
  if (json_fields::optional(object, "x") != nullptr && json_fields::optional(object, "y") != nullptr) {
    waypoint.position = Point2(json_fields::number(object["x"], where + " 'x'"),
                               json_fields::number(object["y"], where + " 'y'"));
  }
  return waypoint;
}

}  // namespace

Route read_route(const std::string& path) {
  const Json object = json_fields::read_object(path);
  Route route;
  route.id = json_fields::text_or(object, "id", "", path + ":");
  route.frame_id = json_fields::text_or(object, "frame_id", "", path + ":");
  route.map_version = json_fields::text_or(object, "map_version", "", path + ":");
  for (const Json& element : json_fields::list(object, "roads", path + ":")) {
    const std::string where = path + ": road " + std::to_string(route.roads.size());
    if (!element.is_object()) json_fields::fail(where, "must be an object");
    RouteRoad road;
    road.id = json_fields::text_or(element, "id", "", where);
    for (const Json& passage : json_fields::list(element, "passages", where)) {
      road.passages.push_back(
          passage_of(passage, where + ", passage " + std::to_string(road.passages.size())));
    }
    route.roads.push_back(std::move(road));
  }
  for (const Json& waypoint : json_fields::list(object, "waypoints", path + ":")) {
    route.waypoints.push_back(
        waypoint_of(waypoint, path + ": waypoint " + std::to_string(route.waypoints.size())));
  }
  route.distance = json_fields::number_or(object, "distance", 0.0, path + ":");
  return route;
}

std::string route_text(const Route& route) {
  Json roads = Json::array(), waypoints = Json::array();
  for (const RouteRoad& road : route.roads) {
    Json passages = Json::array();
    for (const Passage& passage : road.passages) {
      Json segments = Json::array();
      for (const LaneSegment& segment : passage.segments) {
        segments.push_back({{"id", segment.lane_id}, {"start_s", segment.start_s}, {"end_s", segment.end_s}});
      }
      passages.push_back({{"segments", segments},
                          {"can_exit", passage.can_exit},
                          {"change_lane_type", kChanges[static_cast<std::size_t>(passage.change_lane)]}});
    }
    roads.push_back({{"id", road.id}, {"passages", passages}});
  }
  for (const RouteWaypoint& waypoint : route.waypoints) {
    Json object = {{"id", waypoint.lane_id}, {"s", waypoint.s}};
    if (waypoint.position) {
      object["x"] = waypoint.position->x();
      object["y"] = waypoint.position->y();
    }
    waypoints.push_back(object);
  }
  Json object = {{"roads", roads}, {"waypoints", waypoints}, {"distance", route.distance}};
  if (!route.frame_id.empty()) object["frame_id"] = route.frame_id;
  if (!route.map_version.empty()) object["map_version"] = route.map_version;
  return object.dump();
}

}  // namespace relative_map::core
