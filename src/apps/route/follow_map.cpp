// The route on a relative map without ROS: which lane to be on, and how to get there.
#include <cmath>
#include <iostream>
#include <limits>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "navigation_line_command.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/route/relative_map_route.hpp"
#include "route_command.hpp"
#include "route_json.hpp"

namespace relative_map {
namespace {

using Json = nlohmann::json;

constexpr const char* kHelp = R"(Usage: rosrun relative_map follow_map --map FILE

Prints as one JSON object what a planner is told on a relative map, seen from its origin: the lane that the vehicle
is on, the lane to get to, for each lane the lane changes from it and to it, and the segments; or {"refused": "why"}.
  --map FILE   JSON object with a key for each lane id, from left to right: {"centerline": [[x, y]...], "priority",
               "left_neighbors": [id...], "right_neighbors": [id...][, "remaining_distance"]}; m in the body frame
Exit codes: 0 done, 1 failed, 2 bad arguments.
)";

double number(const Json& value, const std::string& where) {
  if (!value.is_number()) throw std::runtime_error(where + " must be a number");
  return value.get<double>();
}

std::string first_id(const Json& lane, const char* key, const std::string& where) {
  if (!lane.contains(key) || lane[key].empty()) return "";
  if (!lane[key].is_array() || !lane[key][0].is_string())
    throw std::runtime_error(where + " '" + key + "' must be a list of lane ids");
  return lane[key][0].get<std::string>();
}

core::Lane lane_of(const std::string& id, const Json& object) {
  const std::string where = "lane '" + id + "'";
  if (!object.is_object() || !object.contains("centerline") || !object["centerline"].is_array())
    throw std::runtime_error(where + " lacks a list 'centerline'");
  core::Lane lane;
  lane.id = id;
  if (object.contains("priority")) {
    const double priority = number(object["priority"], where + " 'priority'");
    if (!(priority >= 0.0 && priority < 1e9))
      throw std::runtime_error(where + " 'priority' must not be negative");
    lane.priority = static_cast<std::uint32_t>(priority);
  }
  lane.left_neighbor_id = first_id(object, "left_neighbors", where);
  lane.right_neighbor_id = first_id(object, "right_neighbors", where);
  lane.remaining_distance = std::numeric_limits<double>::infinity();
  if (object.contains("remaining_distance"))
    lane.remaining_distance = number(object["remaining_distance"], where + " 'remaining_distance'");
  for (const Json& element : object["centerline"]) {
    if (!element.is_array() || element.size() != 2)
      throw std::runtime_error(where + " has a point that is no pair");
    core::PathPoint point;
    point.position = {number(element[0], where), number(element[1], where)};
    lane.path.push_back(point);
  }
  return lane;
}

core::RelativeMap map_of(const Json& file) {
  core::RelativeMap map;
  const Json& lanes = file.contains("map") ? file["map"] : file;
  if (!lanes.is_object()) throw std::runtime_error("the map must be a JSON object with a key for each lane");
  for (const auto& [id, lane] : lanes.items()) map.lanes.push_back(lane_of(id, lane));
  return map;
}

Json passages_of(const core::RelativeMapRoute& route, const core::RelativeMap& map) {
  Json passages = Json::object();
  for (const core::Lane& lane : map.lanes) {
    for (const core::RouteSegments& segments : route.update.segments) {
      if (segments.id != lane.id) continue;
      Json passage;
      passage["on_segment"] = segments.is_on_segment;
      passage["next_action"] = name_of(segments.next_action);
      passage["can_exit"] = segments.can_exit;
      passage["previous_action"] = name_of(segments.previous_action);
      passage["order"] = segments.priority;
      passage["driven_on"] = segments.is_on_segment || segments.is_neighbor;
      passages[lane.id] = passage;
    }
  }
  return passages;
}

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--map"});
  line.files(0, 0, "nothing else");
  if (!line.has("--map")) throw UsageError("--map is needed");
  Json file;
  try {
    file = Json::parse(core::read_whole_file(line.text("--map")));
  } catch (const Json::exception&) {
    throw std::runtime_error(line.text("--map") + ": not valid JSON");
  }
  core::RelativeMap map;
  try {
    map = map_of(file);
  } catch (const std::runtime_error& fault) {
    throw std::runtime_error(line.text("--map") + ": " + fault.what());
  }
  const core::RelativeMapRoute route = core::route_on_relative_map(map);
  Json told = json_of(route.update, nullptr);
  if (!told.contains("refused")) {
    Json object;
    object["current"] = route.current_lane;
    object["target"] = route.target_lane;
    object["passages"] = passages_of(route, map);
    object["segments"] = told["segments"];
    told = object;
  }
  std::cout << told.dump() << '\n';
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_command(argc, argv, "follow_map", relative_map::kHelp, relative_map::run);
}
