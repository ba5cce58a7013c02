#pragma once

#include <string>
#include <vector>

#include "relative_map/model/geo_reference.hpp"

namespace relative_map::core {

/// Hills and cambers of the ground that a drive goes over.
struct TerrainParam {
  double slope = 0.02;        ///< [-] standard deviation of the slope in any direction
  double wavelength = 300.0;  ///< [m] of the longest hill
};

/// Noise as in data sheets of automotive MEMS sensors (gyro 0.014 deg/s/sqrt(Hz), 175 ug/sqrt(Hz)), with the
/// vibration of a car on top of it.
struct SimulatedImuParam {
  double x = 0.4, y = 0.0, z = 0.55;          ///< [m] in the body
  double roll = 0.0, pitch = 0.0, yaw = 0.0;  ///< [rad] of its axes in the body: about x, y, then z
  double gyro_noise = 5e-4;                   ///< [rad/s/sqrt(Hz)]
  double accel_noise = 1.5e-2;                ///< [m/s^2/sqrt(Hz)]
  double gyro_bias = 3e-3;                    ///< [rad/s] standard deviation of an axis, at switching on
  double accel_bias = 0.05;                   ///< [m/s^2] likewise
  double gyro_bias_walk = 8e-6;               ///< [rad/s/sqrt(s)]
  double accel_bias_walk = 2e-4;              ///< [m/s^2/sqrt(s)]
  double stamp_late = 0.0;                    ///< [s] that stamps are after the truth
};

enum class FixQuality { kNone, kNoFix, kPlain, kFloat, kFixed };

/// What befalls the satellites' signals for a while.
struct SkyEpisode {
  enum class Kind { kTunnel, kNoFix, kPlain, kFloat, kMultipath, kJump };
  Kind kind = Kind::kTunnel;
  double start = 0.0, duration = 0.0;  ///< [s] since the drive began

  bool at(double time) const { return time >= start && time < start + duration; }
};

/// Errors as in data sheets of dual-band receivers (RTK 1 cm, 1.5 m alone, both CEP; velocity 0.05 m/s).
struct SimulatedReceiverParam {
  double x = 0.9, y = 0.0, z = 1.5;  ///< [m] antenna in the body
  FixQuality quality = FixQuality::kFixed;
  double rate = 5.0;             ///< [Hz]
  double latency = 0.08;         ///< [s] from a fix to its message
  double stamp_late = 0.0;       ///< [s] that stamps are after the truth
  double fixed = 0.008;          ///< [m] white and slow error of an axis each; twice that upwards
  double floating = 0.25;        ///< [m] slow error
  double plain = 1.2;            ///< [m] slow error
  double slow_time = 120.0;      ///< [s] over which slow errors change
  double velocity = 0.04;        ///< [m/s] white, of an axis
  double multipath = 4.0;        ///< [m] in such an episode, beyond what the receiver says of itself
  double multipath_time = 60.0;  ///< [s] over which it changes
  double jump = 5.0;             ///< [m] likewise
  double refix_time = 4.0;       ///< [s] of floating after a tunnel, before RTK is fixed again
  std::vector<SkyEpisode> sky;
};

struct SimulatedWheelParam {
  double rate = 50.0;            ///< [Hz]
  double speed_noise = 0.03;     ///< [m/s]
  double scale = 0.01;           ///< [-] standard deviation of the share by which tyres are larger than known
  double yaw_rate_noise = 0.01;  ///< [rad/s]
  double yaw_rate_bias = 0.003;  ///< [rad/s] standard deviation
};

struct SensorParam {
  GeoReference map{Projection::kLocal, 0, true, 48.1, 11.5, 520.0};  ///< where the drive's frame lies
  TerrainParam terrain;
  SimulatedImuParam imu;
  SimulatedReceiverParam receiver;
  SimulatedWheelParam wheels;

  /// Every fault as one sentence that names the parameter and its value.
  std::vector<std::string> validate() const;
};

/// "KIND START DURATION", as `tunnel 40 20`; throws std::invalid_argument that says what is expected.
SkyEpisode parse_sky_episode(const std::string& text);

/// rtk, float or plain; throws likewise.
FixQuality parse_fix_quality(const std::string& text);

}  // namespace relative_map::core
