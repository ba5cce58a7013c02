#include "relative_map/simulation/accuracy_scenes.hpp"

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>
#include <utility>

#include "relative_map/simulation/random_process.hpp"
#include "relative_map/simulation/random_roads.hpp"
#include "relative_map/simulation/recording_errors.hpp"

namespace relative_map::core {

namespace {

constexpr double kReferenceSpacing = 0.1;  // [m]
constexpr double kRecordedSpacing = 0.4;   // [m]

/// What the scenes are made of.
struct Builder {
  AccuracyScene scene;
  std::uint64_t seed;
  ErrorLevel level;

  /// `count` lanes side by side; `recorded` of them have a line.
  void lay(const RoadShape& road, std::size_t count, double half_width, bool recorded = true) {
    scene.reference = road.lane(0.0, kReferenceSpacing, "road");
    std::vector<PaintLine>& paint = scene.vehicle.paint.lines;
    for (std::size_t i = 0; i <= count; ++i) {
      const double l = half_width * (static_cast<double>(count) - 2.0 * static_cast<double>(i));
      const bool edge = i == 0 || i == count;
      paint.push_back({l, edge ? BoundaryType::kSolidWhite : BoundaryType::kDottedWhite});
    }
    for (std::size_t i = 0; i < count; ++i) {
      const double l = paint[i].l - half_width;
      scene.lanes.push_back({l, half_width, i, i + 1});
      if (!recorded) continue;
      RecordedLine line = road.lane(l, kRecordedSpacing, "lane_" + std::to_string(i));
      line.priority = static_cast<std::uint32_t>(i);
      // Each lane was recorded on a drive of its own.
      scene.lines.push_back(record_line(line, scene.vehicle.errors.recording, seed + 1000000 * (i + 1)));
    }
  }
  void drive(double speed, double duration, double offset = 0.0) {
    scene.vehicle.speed.max_speed = speed;
    scene.vehicle.offset = offset;
    scene.duration = duration;
  }
};

void motorway(Builder& b) {
  b.lay(motorway_road(b.seed, 3000.0), 3, 1.75);
  b.drive(30.0, 90.0);
}

void country(Builder& b) {
  b.lay(country_road(b.seed, 1600.0), 1, 1.75);
  b.drive(18.0, 90.0);
}

void urban(Builder& b) {
  b.lay(urban_road(b.seed, 1000.0), 1, 1.75);
  b.drive(12.0, 100.0);
}

void loop(Builder& b) {
  b.lay(closed_road(random_start(b.seed)), 1, 1.75);
  b.drive(15.0, 150.0);
}

void lane_change(Builder& b) {
  b.lay(motorway_road(b.seed, 2600.0), 3, 1.75);
  b.drive(22.0, 100.0);
  double start = 300.0;
  for (const double shift : {3.5, -3.5, -3.5, 3.5, 3.5}) {
    b.scene.vehicle.lane_changes.push_back({start, 90.0, shift});
    start += 330.0;
  }
}

void end_of_line(Builder& b) {
  const RoadShape road = country_road(b.seed, 600.0);
  b.lay(road, 1, 1.75);
  b.drive(15.0, 80.0);
  // The road goes on, with its paint.
  std::vector<LinePoint>& points = b.scene.lines.front().points;
  const double left = 100.0 / road.length();  // share of the points, which are evenly spaced
  points.resize(static_cast<std::size_t>((1.0 - left) * static_cast<double>(points.size())));
  b.scene.end_s = b.scene.vehicle.stop_s = road.length() - 100.5;
}

void stop_and_reverse(Builder& b) {
  b.lay(country_road(b.seed, 1200.0), 1, 1.75);
  b.drive(12.0, 90.0);
  b.scene.vehicle.speed_changes = {{25.0, 0.0},  {34.0, -2.0}, {46.0, 0.0},
                                   {49.0, 10.0}, {70.0, 3.0},  {76.0, 14.0}};
}

void widening(Builder& b) {
  b.lay(country_road(b.seed, 1600.0), 1, 1.75);
  b.drive(18.0, 80.0);
  std::vector<PaintLine>& paint = b.scene.vehicle.paint.lines;
  paint[1].shift = -3.5;  // an exit
  paint[1].from_s = 300.0;
  paint[1].to_s = 360.0;
  paint[0].shift = 3.5;  // a turning lane
  paint[0].from_s = 800.0;
  paint[0].to_s = 860.0;
}

void narrow(Builder& b) {
  b.lay(motorway_road(b.seed, 2000.0), 3, 1.6);
  b.drive(22.0, 80.0, 3.2);
}

void wide(Builder& b) {
  b.lay(country_road(b.seed, 1600.0), 1, 1.875);
  b.drive(18.0, 80.0);
}

void drift(Builder& b, const RoadShape& road, std::size_t lanes, double speed) {
  b.scene.group = SceneGroup::kDrifting;
  b.scene.vehicle.errors.localization.drift = b.level.scale * 12.0;
  b.lay(road, lanes, 1.75);
  b.drive(speed, 105.0);
}

void drift_1(Builder& b) {
  drift(b, country_road(b.seed, 1700.0), 1, 15.0);
}

void drift_3(Builder& b) {
  drift(b, country_road(b.seed, 1700.0), 3, 15.0);
}

void drift_straights(Builder& b) {
  drift(b, long_straights_road(b.seed, 1700.0), 1, 15.0);
}

void drift_motorway(Builder& b) {
  drift(b, motorway_road(b.seed, 3200.0), 3, 28.0);
}

void perception(Builder& b, const RoadShape& road, std::size_t lanes, double speed) {
  b.scene.group = SceneGroup::kMarkersAlone;
  b.scene.lane_source = LaneSource::kPerception;
  b.lay(road, lanes, 1.75, false);
  b.drive(speed, 90.0);
}

void perception_motorway(Builder& b) {
  perception(b, motorway_road(b.seed, 3000.0), 3, 30.0);
}

void perception_country(Builder& b) {
  perception(b, country_road(b.seed, 1600.0), 1, 18.0);
}

void bad_markers(Builder& b, MarkerFault fault) {
  b.scene.group = SceneGroup::kBadMarkers;
  b.scene.marker_fault = fault;
  b.lay(country_road(b.seed, 1200.0), 1, 1.75);
  b.drive(18.0, 60.0);
}

void lane_off(Builder& b) {
  bad_markers(b, MarkerFault::kLaneOff);
}

void mirrored(Builder& b) {
  bad_markers(b, MarkerFault::kMirrored);
}

void frozen(Builder& b) {
  bad_markers(b, MarkerFault::kFrozen);
}

void future(Builder& b) {
  bad_markers(b, MarkerFault::kFuture);
}

void perfect(Builder& b) {
  b.scene.group = SceneGroup::kPerfect;
  VehicleSimulationConfig& vehicle = b.scene.vehicle;
  vehicle.noise = NoiseParam{0.0, 0.0, 0.0, 0.0, 0.0};
  vehicle.errors = ErrorParam();
  vehicle.paint.max_residual = 0.005;
  b.lay(country_road(b.seed, 1600.0), 1, 1.75);
  b.drive(18.0, 80.0);
}

const std::vector<std::pair<std::string, std::function<void(Builder&)>>>& scenes() {
  static const std::vector<std::pair<std::string, std::function<void(Builder&)>>> all = {
      {"motorway", motorway},
      {"country", country},
      {"urban", urban},
      {"loop", loop},
      {"lane-change", lane_change},
      {"end-of-line", end_of_line},
      {"stop-and-reverse", stop_and_reverse},
      {"widening", widening},
      {"narrow-lanes", narrow},
      {"wide-lane", wide},
      {"drift-one-line", drift_1},
      {"drift-three-lines", drift_3},
      {"drift-long-straights", drift_straights},
      {"drift-motorway", drift_motorway},
      {"perception-motorway", perception_motorway},
      {"perception-country", perception_country},
      {"bad-lane-off", lane_off},
      {"bad-mirrored", mirrored},
      {"bad-frozen", frozen},
      {"bad-future", future},
      {"perfect", perfect}};
  return all;
}

}  // namespace

std::vector<std::string> accuracy_scene_names() {
  std::vector<std::string> names;
  for (const auto& [name, make] : scenes()) names.push_back(name);
  return names;
}

void set_usual_errors(VehicleSimulationConfig& config, const ErrorLevel& level) {
  const double scale = level.scale;
  config.noise.localization_position = 0.025 * scale;
  config.noise.localization_heading = 0.0035 * scale;  // 0.2 degrees
  config.noise.yaw_rate = 0.003 * scale;
  config.noise.chassis_speed = 0.03 * scale;
  // Together 0.25 m at 50 m.
  config.noise.marker_c0 = 0.03 * scale;
  config.noise.marker_c1 = 0.003 * scale;
  config.noise.marker_c2 = 6e-5 * scale;
  config.noise.marker_c3 = 1e-6 * scale;

  ErrorParam& errors = config.errors;
  errors.localization.bias = 0.3 * scale;
  errors.localization.heading_bias = 0.3 * kPi / 180.0 * scale;
  errors.localization.yaw_rate_bias = 0.002 * scale;
  errors.chassis.speed_scale = 0.01 * scale;
  errors.recording.offset = 0.15 * scale;
  errors.recording.wander = 0.1 * scale;
  errors.markers.correlated_share = 0.5;
  errors.markers.view_range_change = 12.0;
  errors.markers.dropout.interval = 12.0;
  errors.markers.outlier.interval = 10.0;
  errors.markers.min_latency = 0.05;
  errors.markers.max_latency = 0.15;
  config.paint.max_turn = 0.6;
  config.paint.max_residual = 0.03;
  if (!level.harsh) return;
  errors.markers.correlated_share = 0.8;
  errors.markers.correlation_time = 3.0;
  errors.markers.common_share = 0.5;
  errors.markers.dropout.interval = 6.0;
  errors.markers.outlier.interval = 5.0;
}

AccuracyScene make_accuracy_scene(const std::string& name, std::uint64_t seed, const ErrorLevel& level) {
  for (std::size_t i = 0; i < scenes().size(); ++i) {
    const auto& [scene_name, make] = scenes()[i];
    if (scene_name != name) continue;
    Builder builder{{}, 1000 * seed + i, level};  // no scene has another's errors
    builder.scene.name = name;
    builder.scene.vehicle.seed = builder.seed;
    set_usual_errors(builder.scene.vehicle, level);
    make(builder);
    return std::move(builder.scene);
  }
  throw std::invalid_argument("there is no scene '" + name + "'");
}

AccuracyScene make_line_scene(const RecordedLine& line, std::uint64_t seed, const ErrorLevel& level) {
  const double half_width = 1.75;
  AccuracyScene scene;
  scene.name = line.name;
  scene.reference = line;
  scene.lanes.push_back({0.0, half_width, 0, 1});
  scene.vehicle.seed = seed;
  scene.vehicle.paint.lines = {{half_width, BoundaryType::kSolidWhite},
                               {-half_width, BoundaryType::kSolidWhite}};
  set_usual_errors(scene.vehicle, level);
  scene.lines.push_back(record_line(line, scene.vehicle.errors.recording, seed + 1000000));
  scene.lines.front().priority = 0;
  scene.vehicle.speed.max_speed = 15.0;
  return scene;
}

}  // namespace relative_map::core
