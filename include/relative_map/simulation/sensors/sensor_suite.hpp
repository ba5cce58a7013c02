#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <variant>
#include <vector>

#include "relative_map/simulation/noise.hpp"
#include "relative_map/simulation/random_process.hpp"
#include "relative_map/simulation/sensors/earth_motion.hpp"

namespace relative_map::core {

struct SimulatedImu {
  Eigen::Vector3d angular_velocity, specific_force;  ///< [rad/s], [m/s^2] in the sensor's axes
};

struct SimulatedFix {
  GeoPoint place;
  FixQuality quality = FixQuality::kFixed;
  double stddev = 0.0, vertical_stddev = 0.0;  ///< [m] that the receiver states
};

struct SimulatedVelocity {
  Eigen::Vector3d velocity;  ///< [m/s] east, north, up
  double stddev = 0.0;       ///< [m/s] that the receiver states
};

struct SimulatedWheels {
  double speed = 0.0, yaw_rate = 0.0;  ///< [m/s], [rad/s]
};

/// A sensor's message: what it says, its stamp, and when it arrives.
struct SimulatedReading {
  double stamp = 0.0, arrival = 0.0;  ///< [s]
  std::variant<SimulatedImu, SimulatedFix, SimulatedVelocity, SimulatedWheels> data;
};

/// The inertial sensor: noise, biases, mount.
class SimulatedImuSensor {
 public:
  SimulatedImuSensor(const SimulatedImuParam& param, std::uint64_t seed);
  SimulatedReading measure(const BodyMotion& motion);

 private:
  SimulatedImuParam param_;
  NoiseSource noise_;
  Eigen::Matrix3d sensor_from_body_;
  Eigen::Vector3d gyro_bias_, accel_bias_;
};

/// The satellite receiver, under a sky that changes.
class SimulatedReceiver {
 public:
  SimulatedReceiver(const SimulatedReceiverParam& param, std::uint64_t seed);
  /// A fix and a velocity, or nothing in a tunnel. `since_start` [s] of the drive.
  std::vector<SimulatedReading> measure(const BodyMotion& motion, double since_start);
  FixQuality quality_at(double since_start) const;

 private:
  bool is_in(SkyEpisode::Kind kind, double since_start) const;

  SimulatedReceiverParam param_;
  NoiseSource noise_;
  std::vector<OrnsteinUhlenbeck> slow_, multipath_;  ///< east, north, up; of standard deviation 1
  Eigen::Vector3d jump_;                             ///< [m]
};

/// Wheel sensors of the rear axle, a little wrong in scale and yaw rate.
class SimulatedWheelSensor {
 public:
  SimulatedWheelSensor(const SimulatedWheelParam& param, std::uint64_t seed);
  SimulatedReading measure(const BodyMotion& motion);

 private:
  SimulatedWheelParam param_;
  NoiseSource noise_;
  double scale_, yaw_rate_bias_;
};

/// All sensors of a vehicle whose true poses are known, at the rate at which these come.
class SensorSuite {
 public:
  /// Throws std::invalid_argument if `param` has faults.
  SensorSuite(const SensorParam& param, std::uint64_t seed);

  /// The next true pose in the map, `time` [s]. What the sensors say one step before then is known. Where
  /// time goes backwards or stands still, the sensors miss samples.
  void drive(double time, const Pose2& map_from_body);
  /// Those that have arrived by `time`, in the order of their arrival.
  std::vector<SimulatedReading> take(double time);
  const EarthPose& latest() const { return poses_[2]; }
  FixQuality quality_at(double since_start) const { return receiver_.quality_at(since_start); }

 private:
  SensorParam param_;
  MapOnEarth map_;
  SimulatedImuSensor imu_;
  SimulatedReceiver receiver_;
  SimulatedWheelSensor wheels_;
  std::array<EarthPose, 3> poses_;
  int known_ = 0;
  std::optional<double> start_;                ///< [s] of the first pose
  double next_fix_ = 0.0, next_wheels_ = 0.0;  ///< [s]
  std::vector<SimulatedReading> waiting_;
};

}  // namespace relative_map::core
