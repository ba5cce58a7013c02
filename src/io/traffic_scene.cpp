#include "relative_map/io/traffic_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>

namespace relative_map::core {

namespace {

using Json = nlohmann::json;

[[noreturn]] void fail(const std::string& file, const std::string& what) {
  throw std::runtime_error(file + ": " + what);
}

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> cells;
  std::istringstream stream(line);
  for (std::string cell; std::getline(stream, cell, ',');) {
    while (!cell.empty() && (cell.back() == '\r' || cell.back() == ' ')) cell.pop_back();
    cells.push_back(cell);
  }
  if (!line.empty() && line.back() == ',') cells.emplace_back();
  return cells;
}

RoadUserType type_of(const std::string& name) {
  if (name == "VEHICLE" || name == "CAR" || name == "TRUCK" || name == "BUS" || name == "MOTORCYCLE") {
    return RoadUserType::kVehicle;
  }
  if (name == "PEDESTRIAN") return RoadUserType::kPedestrian;
  if (name == "BICYCLE" || name == "CYCLIST") return RoadUserType::kBicycle;
  return RoadUserType::kUnknown;
}

/// The table's columns by their names.
class Table {
 public:
  Table(const std::string& file, const std::string& header) : file_(file) {
    const std::vector<std::string> names = split(header);
    for (std::size_t i = 0; i < names.size(); ++i) columns_[names[i]] = i;
    for (const char* needed : {"id", "type", "t", "x", "y"}) {
      if (columns_.count(needed) == 0) fail(file, std::string("has no column '") + needed + "'");
    }
  }
  void set_line(std::size_t number, const std::string& line) {
    number_ = number;
    cells_ = split(line);
    if (cells_.size() != columns_.size()) fault("has " + std::to_string(cells_.size()) + " cells");
  }
  const std::string& text(const std::string& name) const { return cells_[columns_.at(name)]; }
  /// `otherwise` where there is no such column or nothing in it.
  double number(const std::string& name, double otherwise) const {
    const auto column = columns_.find(name);
    if (column == columns_.end() || cells_[column->second].empty()) return otherwise;
    const std::string& cell = cells_[column->second];
    char* end = nullptr;
    const double value = std::strtod(cell.c_str(), &end);
    if (end != cell.c_str() + cell.size()) fault("'" + cell + "' in column '" + name + "' is no number");
    return value;
  }

 private:
  [[noreturn]] void fault(const std::string& what) const {
    fail(file_, "line " + std::to_string(number_) + ": " + what);
  }
  std::string file_;
  std::map<std::string, std::size_t> columns_;
  std::size_t number_ = 0;
  std::vector<std::string> cells_;
};

void read_tracks(const std::string& file, TrafficScene& scene) {
  std::ifstream stream(file);
  std::string line;
  if (!stream || !std::getline(stream, line)) fail(file, "can't be read, or is empty");
  Table table(file, line);
  std::map<std::string, int> ids;
  for (std::size_t number = 2; std::getline(stream, line); ++number) {
    if (line.empty() || line == "\r") continue;
    table.set_line(number, line);
    SceneSample sample;
    const double t = table.number("t", kNotGiven);
    if (!std::isfinite(t) || std::abs(t) > 1e9)
      fail(file, "line " + std::to_string(number) + ": t is no time");
    sample.stamp = at_seconds(t);
    SeenRoadUser& seen = sample.seen;
    const auto id = ids.emplace(table.text("id"), static_cast<int>(ids.size()));
    seen.id = id.first->second;
    scene.names.emplace(seen.id, table.text("id"));
    scene.types.emplace(seen.id, table.text("type"));
    seen.type = type_of(table.text("type"));
    seen.position = {table.number("x", kNotGiven), table.number("y", kNotGiven)};
    seen.heading = table.number("heading", kNotGiven);
    seen.velocity = {table.number("vx", kNotGiven), table.number("vy", kNotGiven)};
    seen.length = table.number("length", 0.0);
    seen.width = table.number("width", 0.0);
    sample.ego = table.number("ego", 0.0) != 0.0;
    scene.samples.push_back(sample);
  }
  std::stable_sort(scene.samples.begin(), scene.samples.end(),
                   [](const SceneSample& a, const SceneSample& b) {
                     return a.stamp != b.stamp ? a.stamp < b.stamp : a.seen.id < b.seen.id;
                   });
}

Polyline points_of(const Json& lane, const char* name) {
  Polyline points;
  if (!lane.contains(name) || lane[name].is_null()) return points;
  for (const Json& point : lane[name])
    points.emplace_back(point.at(0).get<double>(), point.at(1).get<double>());
  return points;
}

std::vector<std::string> texts_of(const Json& lane, const char* name) {
  std::vector<std::string> texts;
  if (!lane.contains(name) || lane[name].is_null()) return texts;
  for (const Json& text : lane[name]) texts.push_back(text.get<std::string>());
  return texts;
}

std::string neighbor_of(const Json& lane, const char* name, const char* same_direction) {
  if (!lane.contains(name) || lane[name].is_null()) return "";
  if (lane.contains(same_direction) && lane[same_direction].is_boolean() &&
      !lane[same_direction].get<bool>()) {
    return "";
  }
  return lane[name].get<std::string>();
}

/// [m] from the middle of the centerline to a boundary; 0: not known.
double width_to(const Polyline& center, const Polyline& boundary) {
  if (center.size() < 2 || boundary.size() < 2) return 0.0;
  double sum = 0.0;
  for (const Point2& point : center) {
    double nearest = 1e12;
    for (std::size_t i = 0; i + 1 < boundary.size(); ++i) {
      nearest = std::min(nearest, project_on_segment(boundary[i], boundary[i + 1], point).squared_distance);
    }
    sum += std::sqrt(nearest);
  }
  return sum / static_cast<double>(center.size());
}

LaneUse use_of(const std::string& type) {
  if (type.find("BIKE") != std::string::npos || type.find("BICYCLE") != std::string::npos) {
    return LaneUse::kBicycles;
  }
  if (type.find("SIDEWALK") != std::string::npos || type.find("CROSSWALK") != std::string::npos) {
    return LaneUse::kPedestrians;
  }
  return type.find("PARKING") != std::string::npos ? LaneUse::kParking : LaneUse::kVehicles;
}

TrafficLane lane_of(const Json& json) {
  TrafficLane lane;
  lane.id = json.at("id").get<std::string>();
  lane.center = points_of(json, "center");
  lane.left_width = width_to(lane.center, points_of(json, "left"));
  lane.right_width = width_to(lane.center, points_of(json, "right"));
  if (json.contains("speed_limit") && json["speed_limit"].is_number()) {
    lane.speed_limit = json["speed_limit"].get<double>();
  }
  if (json.contains("type") && json["type"].is_string()) lane.use = use_of(json["type"].get<std::string>());
  lane.in_junction = json.contains("is_intersection") && json["is_intersection"].is_boolean() &&
                     json["is_intersection"].get<bool>();
  lane.successors = texts_of(json, "succ");
  lane.predecessors = texts_of(json, "pred");
  lane.left_neighbor = neighbor_of(json, "left_nb", "left_same_dir");
  lane.right_neighbor = neighbor_of(json, "right_nb", "right_same_dir");
  return lane;
}

void read_lanes(const std::string& file, TrafficLanes& lanes) {
  std::ifstream stream(file);
  if (!stream) return;  // pedestrians on a square have none
  try {
    const Json json = Json::parse(stream);
    for (const Json& lane : json.at("lanes")) lanes.lanes.push_back(lane_of(lane));
  } catch (const Json::exception& fault) {
    fail(file, std::string("is not what it should be: ") + fault.what());
  }
}

}  // namespace

TrafficScene read_traffic_scene(const std::string& folder) {
  TrafficScene scene;
  const std::filesystem::path path(folder);
  if (!std::filesystem::is_directory(path)) fail(folder, "is no folder");
  read_tracks((path / "tracks.csv").string(), scene);
  read_lanes((path / "lanes.json").string(), scene.lanes);
  return scene;
}

}  // namespace relative_map::core
