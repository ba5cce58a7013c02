#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "relative_map/simulation/accuracy_scenes.hpp"
#include "relative_map/simulation/error_param.hpp"
#include "relative_map/simulation/marker_errors.hpp"
#include "relative_map/simulation/transmission.hpp"

namespace relative_map::core {

// A world is a family of drives: one kind of road, vehicle and errors, of which a seed gives one. What a map
// makes of drives in many worlds, with one setting for all, tells how it does in a world that nobody knows.
// A world's sizes come from classes of sensors and from roads, never from what the pipeline assumes of them.

enum class RoadKind {
  kMotorway,  ///< radii from 600 m on
  kCountry,   ///< 80 to 300 m
  kUrban,     ///< blocks with corners of 12 to 20 m, and bends
  kTown,      ///< an old town: corners down to 4 m
  kLoop,      ///< laps of a closed road with radii of 60 m
};

/// Lanes side by side, of which one is driven.
struct WorldRoad {
  RoadKind kind = RoadKind::kCountry;
  std::size_t lanes = 1;
  std::size_t driven = 0;                          ///< from the left
  double min_width = 3.25, max_width = 3.75;       ///< [m] of a lane; each is drawn
  double min_paint_radius = 0.0;                   ///< [m] bends that are sharper have no paint
  bool left_painted = true, right_painted = true;  ///< of the outermost borders
  double width_change = 0.0;                       ///< [m] by which the widths change along the road, most
};

enum class Manoeuvre {
  kSteady,
  kLaneChanges,
  kStopAndGo,
  kReverse,  ///< stops, goes back for a while, and on again
  kLineEnd,  ///< stops a metre before the line's end; the road goes on
};

struct WorldDrive {
  double speed = 15.0;     ///< [m/s] where the road allows it
  double duration = 60.0;  ///< [s]
  Manoeuvre manoeuvre = Manoeuvre::kSteady;
};

/// What tells where the vehicle is.
struct LocalizationClass {
  double position_noise = 0.0;  ///< [m] white, in x and in y
  double heading_noise = 0.0;   ///< [rad] white
  double velocity_noise = 0.0;  ///< [m/s] white
  LocalizationErrorParam errors;
  TransmissionParam transmission;
};

/// What tells how it moves: a gyro and wheels.
struct OdometryClass {
  double yaw_rate_noise = 0.0;  ///< [rad/s] white
  double yaw_rate_bias = 0.0;   ///< [rad/s] greatest
  double yaw_rate_scale = 0.0;  ///< [-] greatest
  double speed_noise = 0.0;     ///< [m/s] white
  double speed_scale = 0.0;     ///< [-] greatest
  TransmissionParam transmission;
};

/// What sees the paint.
struct CameraClass {
  CubicNoise noise;
  double range = 50.0;         ///< [m] on average
  double max_turn = 0.6;       ///< [rad] half the angle that it sees
  double max_residual = 0.04;  ///< [m] of its cubics
  MarkerErrorParam errors;
  TransmissionParam transmission;
};

/// How the lines were recorded.
struct RecordingClass {
  RecordingErrorParam errors;
  double spacing = 0.5;  ///< [m] of the points
};

/// Lines of other roads, or of other days.
enum class OtherLines {
  kNone,
  kCrossings,  ///< straight across, aside by 30 to 80 degrees, and of the better priority
  kRamp,       ///< one comes from the right, merges, and goes on in the driven lane
  kFork,       ///< one leaves the driven lane to the right; it is of the worse priority
  kDouble,     ///< the driven lane was recorded twice
};

struct World {
  std::string name;  ///< family.member
  std::string what;  ///< a sentence's part, for the table
  WorldRoad road;
  WorldDrive drive;
  LocalizationClass localization;
  OdometryClass odometry;
  CameraClass camera;
  RecordingClass recording;
  OtherLines others = OtherLines::kNone;
};

const std::vector<World>& worlds();

/// The names that are `name` or begin with it and a dot. Throws std::invalid_argument if there is none.
std::vector<std::string> worlds_named(const std::string& name);

/// One drive in a world. `markers_alone`: without lines, in a map from lane markers alone.
/// Throws std::invalid_argument if there is no world of that name.
AccuracyScene make_world_scene(const std::string& name, std::uint64_t seed, bool markers_alone = false);
AccuracyScene make_world_scene(const World& world, std::uint64_t seed, bool markers_alone = false);

}  // namespace relative_map::core
