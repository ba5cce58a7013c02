#pragma once

#include <map>
#include <string>
#include <vector>

#include "relative_map/model/road_users.hpp"
#include "relative_map/model/traffic_lanes.hpp"

namespace relative_map::core {

/// One road user at one time, as a scene has it.
struct SceneSample {
  Time stamp{};
  SeenRoadUser seen;
  bool ego = false;
};

/// Recorded traffic: a folder with tracks.csv and, if there is a map, lanes.json.
struct TrafficScene {
  std::vector<SceneSample> samples;  ///< by rising stamp, then by id
  std::map<int, std::string> names;  ///< ids as the file has them, which need not be numbers
  std::map<int, std::string> types;  ///< as the file has them
  TrafficLanes lanes;
};

/// Throws std::runtime_error, one sentence with the file and, in a table, the line.
TrafficScene read_traffic_scene(const std::string& folder);

}  // namespace relative_map::core
