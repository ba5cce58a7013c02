#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/drive_path.hpp"
#include "relative_map/simulation/error_param.hpp"
#include "relative_map/simulation/localization_errors.hpp"
#include "relative_map/simulation/marker_errors.hpp"
#include "relative_map/simulation/noise.hpp"
#include "relative_map/simulation/paint.hpp"
#include "relative_map/simulation/speed_profile.hpp"
#include "relative_map/simulation/wander.hpp"

namespace relative_map::core {

/// Standard deviations of white Gaussian noise.
struct NoiseParam {
  double localization_position = 0.02;  ///< [m] in x and in y
  double localization_heading = 0.001;  ///< [rad]
  double chassis_speed = 0.02;          ///< [m/s]
  double marker_c0 = 0.02;              ///< [m]
  double marker_c1 = 0.001;             ///< [-]
  double marker_c2 = 0.0;               ///< [1/m]
  double marker_c3 = 0.0;               ///< [1/m^2]
  double yaw_rate = 0.0;                ///< [rad/s]
  double localization_velocity = 0.0;   ///< [m/s] in x and in y
};

/// The paint of the road that is driven on, and how the camera sees it.
struct PaintParam {
  double lane_half_width = 1.75;  ///< [m]
  double view_range = 50.0;       ///< [m]
  double quality = 0.9;           ///< [0, 1] of markers that are seen
  BoundaryType left_type = BoundaryType::kDottedWhite;
  BoundaryType right_type = BoundaryType::kDottedWhite;
  std::vector<PaintLine> lines;  ///< from left to right; none: the two at lane_half_width
  double max_turn = 0.78;        ///< [rad] by which the road may turn before it is out of sight
  double max_residual = 0.05;    ///< [m] of the cubics; where they can't follow the paint they end
  double min_radius = 0.0;       ///< [m] of the road; sharper bends have no paint
};

/// Moves the vehicle sideways for good.
struct LaneChange {
  double start = 0.0;     ///< [m] of distance driven along the line
  double length = 100.0;  ///< [m]
  double shift = 0.0;     ///< [m] left positive
};

/// The driver's wish from a time on.
struct SpeedChange {
  double time = 0.0;   ///< [s]
  double speed = 0.0;  ///< [m/s] negative: backwards
};

struct VehicleSimulationConfig {
  std::uint64_t seed = 1;
  double start_s = 0.0;             ///< [m] along the line
  double stop_s = 0.0;              ///< [m] along an open line, where the vehicle stops; 0: at its end
  double wander = 0.2;              ///< [m] greatest lateral offset from the line
  double wander_wavelength = 80.0;  ///< [m] of the slowest sway
  double offset = 0.0;              ///< [m] to the left of the line, about which the vehicle wanders
  std::vector<LaneChange> lane_changes;
  std::vector<SpeedChange> speed_changes;  ///< by rising time; before: SpeedParam::max_speed
  SpeedParam speed;
  PaintParam paint;
  NoiseParam noise;
  ErrorParam errors;

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
};

/// A vehicle that drives along a recorded line, and its sensors. No clock: time passes by step().
/// The same line, config and calls give the same run.
class VehicleSimulation {
 public:
  /// Starts at rest. Throws std::invalid_argument if `config` has faults or the line can't be driven on.
  VehicleSimulation(const RecordedLine& line, const VehicleSimulationConfig& config);

  /// Drives on for `dt` [s], 0 or more, with the acceleration's and the curves' limits on the speed. At the
  /// end of an open line the vehicle stands; a lap goes on for ever.
  void step(double dt);
  bool at_end() const { return path_.ends == Ends::kOpen && s_ >= path_.length(); }
  /// Puts the vehicle back to the start, at rest; time and noise go on.
  void restart();

  // The truth.
  Duration time() const { return time_; }  ///< since construction
  Pose2 map_from_base() const { return {path_.origin + pose_.position(), pose_.heading()}; }
  double speed() const { return speed_; }        ///< [m/s] negative: backwards
  double yaw_rate() const { return yaw_rate_; }  ///< [rad/s]
  double s() const { return s_; }                ///< [m] along the line
  double l() const { return l_; }                ///< [m] to the left of the line
  const DrivePath& path() const { return path_; }

  // What the sensors say, stamped time(): each call draws new noise.
  Localization measure_localization();
  Chassis measure_chassis();
  /// Cubics fitted to the paint as it is seen from the true pose. Where less of it than 5 m is left to see,
  /// the marker has quality 0. Left and right is the nearest paint on either side.
  LaneMarkers measure_lane_markers();
  /// From the image that was measured last to its message.
  Duration marker_latency() const { return marker_latency_; }

 private:
  void advance(double dt);
  void place();
  double wished_speed() const;
  LaneMarker measure_marker(const PaintLine& line, double view_range) const;

  VehicleSimulationConfig config_;
  DrivePath path_;
  SpeedProfile speed_profile_;
  Wander wander_;
  NoiseSource localization_noise_, chassis_noise_, velocity_noise_;
  LocalizationErrors localization_errors_;
  MarkerErrors marker_errors_;
  double speed_scale_;  ///< [-] that the chassis measures with
  std::optional<PoseDrift> pose_drift_;

  Duration time_{};
  Duration marker_latency_{};
  double s_ = 0.0;             ///< [m]
  double driven_ = 0.0;        ///< [m] along the line, laps included
  std::size_t vertex_ = 0;     ///< of the path, at or before s_
  double l_ = 0.0;             ///< [m]
  double advance_rate_ = 1.0;  ///< [-] of s by distance driven
  Pose2 pose_;                 ///< in the path's frame
  double speed_ = 0.0;         ///< [m/s]
  double yaw_rate_ = 0.0;      ///< [rad/s]
};

}  // namespace relative_map::core
