#include "reference_data.hpp"

#include <cstdlib>
#include <fstream>
#include <memory>

#include "relative_map/io/navigation_line_file.hpp"

namespace relative_map::core::test {

namespace {

using nlohmann::json;

std::shared_ptr<const PipelineConfig> config_of(const json& scenario) {
  auto config = std::make_shared<PipelineConfig>();
  const json& map = scenario["config"]["map_param"];
  config->map_param.default_left_width = map["default_left_width"];
  config->map_param.default_right_width = map["default_right_width"];
  config->map_param.default_speed_limit = map["default_speed_limit"];
  const json& lane = scenario["config"]["navigation_lane"];
  NavigationLaneParam& param = config->navigation_lane;
  param.lane_source =
      lane["lane_source"] == "PERCEPTION" ? LaneSource::kPerception : LaneSource::kOfflineGenerated;
  param.max_len_from_navigation_line = lane["max_len_from_navigation_line"];
  param.min_len_for_navigation_lane = lane["min_len_for_navigation_lane"];
  param.max_len_for_navigation_lane = lane["max_len_for_navigation_lane"];
  param.ratio_navigation_lane_len_to_speed = lane["ratio_navigation_lane_len_to_speed"];
  param.max_distance_to_navigation_line = lane["max_distance_to_navigation_line"];
  param.lane_marker_weight = lane["lane_marker_weight"];
  config->lane_fusion.method = "fixed_weight";
  // The original knew neither a least quality nor ages.
  param.min_lane_marker_quality = 0.0;
  config->max_age = {1e9, 1e9, 1e9};
  config->enable_cyclic_rerouting = scenario["config"]["enable_cyclic_rerouting"];
  return config;
}

NavigationInfo navigation_of(const json& scenario, const std::string& folder) {
  NavigationInfo info;
  info.frame_id = "map";
  for (const json& line : scenario["navigation_lines"]) {
    RecordedLine recorded = read_navigation_line(folder + "/" + line["file"].get<std::string>());
    recorded.name = line["name"];
    recorded.priority = line["path_priority"];
    info.lines.push_back(std::move(recorded));
  }
  return info;
}

Eigen::Vector3d vector_of(const json& numbers) {
  return {numbers[0].get<double>(), numbers[1].get<double>(), numbers[2].get<double>()};
}

Localization localization_of(const json& message) {
  Localization localization;
  localization.stamp = at_seconds(message["t"]);
  localization.position = vector_of(message["position"]);
  localization.heading = message["heading"];
  // Its orientation is Apollo's RFU, whose yaw is heading - 90 degrees.
  const json& q = message["orientation_wxyz"];
  localization.map_from_body =
      Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * Eigen::AngleAxisd(kPi / 2.0, Eigen::Vector3d::UnitZ());
  localization.linear_velocity = vector_of(message["linear_velocity"]);
  localization.angular_velocity_body = vector_of(message["angular_velocity_vrf"]);
  return localization;
}

LaneMarker marker_of(const json& message) {
  LaneMarker marker;
  marker.type = static_cast<BoundaryType>(message["lane_type"].get<int>());
  marker.quality = message["quality"];
  marker.cubic = Cubic{message["c0_position"], message["c1_heading_angle"], message["c2_curvature"],
                       message["c3_curvature_derivative"]};
  marker.view_range = message["view_range"];
  marker.longitude_start = message["longitude_start"];
  return marker;
}

}  // namespace

std::optional<std::string> reference_folder() {
  const char* given = std::getenv("RELATIVE_MAP_REFERENCE_DATA");
  const std::string folder = given != nullptr ? given : RELATIVE_MAP_DEFAULT_REFERENCE_DATA;
  if (!std::ifstream(folder + "/README.md")) return std::nullopt;
  return folder;
}

json read_json(const std::string& file) {
  std::ifstream stream(file);
  return json::parse(stream);
}

ScenarioRun::ScenarioRun(const std::string& name)
    : scenario_(read_json(reference_folder().value() + "/golden/" + name + ".scenario.json")),
      pipeline_(config_of(scenario_)) {
  pipeline_.set_navigation_lines(
      prepare_navigation_lines(navigation_of(scenario_, reference_folder().value()), {}));
}

RelativeMap ScenarioRun::next() {
  const json& frame = scenario_["frames"].at(frame_++);
  if (frame.contains("chassis")) {
    Chassis chassis;
    chassis.stamp = at_seconds(frame["chassis"]["t"]);
    chassis.speed = frame["chassis"]["speed_mps"];
    pipeline_.set_chassis(chassis);
  }
  if (frame.contains("localization")) pipeline_.set_localization(localization_of(frame["localization"]));
  if (frame.contains("lane_markers")) {
    LaneMarkers markers;
    if (!frame["lane_markers"].is_null()) {
      markers.left = marker_of(frame["lane_markers"]["left"]);
      markers.right = marker_of(frame["lane_markers"]["right"]);
    }
    markers.stamp = pipeline_.pose_stamp().value();
    pipeline_.set_lane_markers(markers);
  }
  return pipeline_.tick(pipeline_.pose_stamp().value());
}

}  // namespace relative_map::core::test
