#include "relative_map/simulation/world.hpp"

#include <cmath>
#include <random>
#include <utility>

#include "relative_map/simulation/random_process.hpp"
#include "relative_map/simulation/recording_errors.hpp"
#include "relative_map/simulation/world_roads.hpp"

namespace relative_map::core {

namespace {

constexpr double kReferenceSpacing = 0.1;      // [m]
constexpr double kSpareRoad = 60.0;            // [m] beyond what is driven
constexpr double kShareToLineEnd = 0.6;        // of the way that could be driven
constexpr double kStopBeforeEnd = 1.0;         // [m]
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
  std::uniform_real_distribution<double> width(road.min_width, road.max_width), wave_length(90.0, 250.0),
      phase(-kPi, kPi);
  std::vector<double> widths;
  double total = 0.0;
  for (std::size_t i = 0; i < road.lanes; ++i) total += widths.emplace_back(width(engine));

  std::vector<PaintLine>& paint = scene.vehicle.paint.lines;
  double l = 0.5 * total;
  for (std::size_t i = 0; i <= road.lanes; ++i) {
    const bool outermost = i == 0 || i == road.lanes;
    paint.push_back({l, outermost ? BoundaryType::kSolidWhite : BoundaryType::kDottedWhite});
    paint.back().wave = 0.5 * road.width_change;
    paint.back().wave_length = wave_length(engine);
    paint.back().wave_phase = phase(engine);
    if (i < road.lanes) {
      scene.lanes.push_back({l - 0.5 * widths[i], 0.5 * widths[i], i, i + 1});
      l -= widths[i];
    }
  }
  paint.front().painted = road.left_painted;
  paint.back().painted = road.right_painted;
}

/// The middle between a lane's borders, from the road's start to where the lines end.
RecordedLine middle_of(const RoadShape& road, const AccuracyScene& scene, const TrueLane& lane,
                       double spacing) {
  const std::vector<PaintLine>& paint = scene.vehicle.paint.lines;
  RecordedLine line = road.lane(lane.l, spacing);
  const double step = road.length() / static_cast<double>(line.points.size() - 1);
  std::vector<LinePoint> points;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const double s = step * static_cast<double>(i);
    if (s > scene.end_s) break;
    const double wave = 0.5 * (paint[lane.left_paint].wave_at(s) + paint[lane.right_paint].wave_at(s));
    const Point2 position = road.at(s, lane.l + wave).position;
    points.push_back(line.points[i]);
    points.back().x = position.x();
    points.back().y = position.y();
  }
  line.points = std::move(points);
  return line;
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
    RecordedLine line = middle_of(road, scene, scene.lanes[i], spacing);
    line.name = "lane_" + std::to_string(i);
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
  } else if (world.drive.manoeuvre == Manoeuvre::kReverse) {
    std::uniform_real_distribution<double> start(15.0, 25.0), back(8.0, 18.0);
    const double stop = start(engine), reverse = stop + 7.0, again = reverse + back(engine);
    vehicle.speed_changes = {{stop, 0.0}, {reverse, -2.0}, {again, 0.0}, {again + 3.0, world.drive.speed}};
  } else if (world.drive.manoeuvre == Manoeuvre::kLineEnd) {
    scene.end_s = kShareToLineEnd * world.drive.speed * world.drive.duration;
    vehicle.stop_s = scene.end_s - kStopBeforeEnd;
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
