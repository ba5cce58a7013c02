#include "relative_map/simulation/world.hpp"

#include <cmath>
#include <random>

#include "relative_map/simulation/random_process.hpp"
#include "relative_map/simulation/recording_errors.hpp"
#include "relative_map/simulation/world_roads.hpp"

namespace relative_map::core {

namespace {

constexpr double kReferenceSpacing = 0.1;      // [m]
constexpr double kSpareRoad = 60.0;            // [m] beyond what is driven
constexpr std::uint64_t kLineSeeds = 1000003;  // between the seeds of two lines' errors

/// Of a world's name, the same on every computer (FNV-1a): no world has another's errors, and a new world
/// leaves those of the others alone.
std::uint64_t hash_of(const std::string& name) {
  std::uint64_t hash = 14695981039346656037u;
  for (const char letter : name) hash = (hash ^ static_cast<unsigned char>(letter)) * 1099511628211u;
  return hash;
}

/// Lanes and paint from left to right about the reference curve.
void lay_lanes(const World& world, std::uint64_t seed, AccuracyScene& scene) {
  const WorldRoad& road = world.road;
  std::mt19937_64 engine = random_engine(seed, 80);
  std::uniform_real_distribution<double> width(road.min_width, road.max_width);
  std::vector<double> widths;
  double total = 0.0;
  for (std::size_t i = 0; i < road.lanes; ++i) total += widths.emplace_back(width(engine));

  std::vector<PaintLine>& paint = scene.vehicle.paint.lines;
  double l = 0.5 * total;
  for (std::size_t i = 0; i <= road.lanes; ++i) {
    const bool outermost = i == 0 || i == road.lanes;
    paint.push_back({l, outermost ? BoundaryType::kSolidWhite : BoundaryType::kDottedWhite});
    if (i < road.lanes) {
      scene.lanes.push_back({l - 0.5 * widths[i], 0.5 * widths[i], i, i + 1});
      l -= widths[i];
    }
  }
  paint.front().painted = road.left_painted;
  paint.back().painted = road.right_painted;
}

void record_lines(const World& world, const RoadShape& road, std::uint64_t seed, AccuracyScene& scene) {
  std::uint64_t line_seed = seed;
  const auto record = [&](const RecordedLine& line) {
    line_seed += kLineSeeds;  // each was recorded on a drive of its own
    scene.lines.push_back(record_line(line, world.recording.errors, line_seed));
  };
  const double driven = scene.lanes[world.road.driven].l, spacing = world.recording.spacing;
  const auto others = other_lines(world.others, road, driven, spacing, seed);
  const bool behind = !others.empty() && others.front().priority == 0;
  for (std::size_t i = 0; i < scene.lanes.size(); ++i) {
    RecordedLine line = road.lane(scene.lanes[i].l, spacing, "lane_" + std::to_string(i));
    line.priority = static_cast<std::uint32_t>(i + (behind ? 1 : 0));
    record(line);
  }
  for (const RecordedLine& line : others) record(line);
}

void set_manoeuvre(const World& world, std::uint64_t seed, AccuracyScene& scene) {
  std::mt19937_64 engine = random_engine(seed, 82);
  VehicleSimulationConfig& vehicle = scene.vehicle;
  if (world.drive.manoeuvre == Manoeuvre::kStopAndGo) {
    std::uniform_real_distribution<double> moving(4.0, 12.0), standing(2.0, 8.0),
        speed(1.0, world.drive.speed);
    for (double time = moving(engine); time < world.drive.duration; time += moving(engine)) {
      vehicle.speed_changes.push_back({time, 0.0});
      time += standing(engine) + 3.0;  // to brake in
      vehicle.speed_changes.push_back({time, speed(engine)});
    }
  } else if (world.drive.manoeuvre == Manoeuvre::kLaneChanges) {
    std::uniform_real_distribution<double> pause(150.0, 300.0), length(60.0, 140.0), side(-1.0, 1.0);
    std::size_t lane = world.road.driven;
    double start = pause(engine);
    while (start < world.drive.speed * world.drive.duration) {
      const bool left = lane + 1 == scene.lanes.size() || (lane > 0 && side(engine) > 0.0);
      const std::size_t next = left ? lane - 1 : lane + 1;
      const double change = length(engine);
      vehicle.lane_changes.push_back({start, change, scene.lanes[next].l - scene.lanes[lane].l});
      lane = next;
      start += change + pause(engine);
    }
  }
}

void set_sensors(const World& world, AccuracyScene& scene) {
  const LocalizationClass& localization = world.localization;
  const OdometryClass& odometry = world.odometry;
  const CameraClass& camera = world.camera;
  VehicleSimulationConfig& vehicle = scene.vehicle;
  vehicle.noise = {localization.position_noise,
                   localization.heading_noise,
                   odometry.speed_noise,
                   camera.noise.c0,
                   camera.noise.c1,
                   camera.noise.c2,
                   camera.noise.c3,
                   odometry.yaw_rate_noise,
                   localization.velocity_noise};
  vehicle.errors.localization = localization.errors;
  vehicle.errors.localization.yaw_rate_bias = odometry.yaw_rate_bias;
  vehicle.errors.localization.yaw_rate_scale = odometry.yaw_rate_scale;
  vehicle.errors.chassis.speed_scale = odometry.speed_scale;
  vehicle.errors.recording = world.recording.errors;
  vehicle.errors.markers = camera.errors;
  vehicle.paint.view_range = camera.range;
  vehicle.paint.max_turn = camera.max_turn;
  vehicle.paint.max_residual = camera.max_residual;
  vehicle.paint.min_radius = world.road.min_paint_radius;
  scene.transmission = {localization.transmission, odometry.transmission, camera.transmission};
}

}  // namespace

AccuracyScene make_world_scene(const World& world, std::uint64_t drive, bool markers_alone) {
  const std::uint64_t seed = hash_of(world.name) + drive;
  AccuracyScene scene;
  scene.name = world.name;
  scene.duration = world.drive.duration;
  scene.vehicle.seed = seed;
  const RoadShape road =
      world_road(world.road.kind, seed, world.drive.speed * world.drive.duration + kSpareRoad);
  scene.reference = road.lane(0.0, kReferenceSpacing, "road");
  set_sensors(world, scene);
  lay_lanes(world, seed, scene);
  scene.vehicle.offset = scene.lanes[world.road.driven].l;
  scene.vehicle.speed.max_speed = world.drive.speed;
  set_manoeuvre(world, seed, scene);
  if (markers_alone) {
    scene.group = SceneGroup::kMarkersAlone;
    scene.lane_source = LaneSource::kPerception;
  } else {
    record_lines(world, road, seed, scene);
  }
  return scene;
}

}  // namespace relative_map::core
