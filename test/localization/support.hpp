#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <vector>

#include "relative_map/localization/geodesy/earth.hpp"
#include "relative_map/localization/geodesy/tangent_plane.hpp"
#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// A drive that is known in closed form: it stands, drives off along a gentle weave, and is level. The body
/// is the inertial sensor; the plane is at its start.
struct KnownDrive {
  GeoPoint origin{11.0, 48.0, 500.0};
  double stand = 5.0;          ///< [s] at the start
  double acceleration = 1.0;   ///< [m/s^2] up to `speed`
  double speed = 10.0;         ///< [m/s]
  double weave = 0.3;          ///< [rad] of the heading to either side
  double weave_rate = 0.4;     ///< [rad/s]
  double first_heading = 0.7;  ///< [rad]

  double time_moving(double t) const { return std::max(0.0, t - stand); }
  double speed_at(double t) const { return std::min(speed, acceleration * time_moving(t)); }
  double heading_at(double t) const {
    return first_heading + weave * (1.0 - std::cos(weave_rate * time_moving(t)));
  }
  double yaw_rate_at(double t) const {
    return t > stand ? weave * weave_rate * std::sin(weave_rate * time_moving(t)) : 0.0;
  }
  Eigen::Vector3d velocity_at(double t) const {
    return speed_at(t) * Eigen::Vector3d(std::cos(heading_at(t)), std::sin(heading_at(t)), 0.0);
  }
  /// By Simpson's rule from position to position; call with rising times.
  Eigen::Vector3d position_at(double t) {
    while (known_until_ < t - 1e-12) {
      const double dt = std::min(0.01, t - known_until_);
      known_ += dt / 6.0 *
                (velocity_at(known_until_) + 4.0 * velocity_at(known_until_ + 0.5 * dt) +
                 velocity_at(known_until_ + dt));
      known_until_ += dt;
    }
    return known_;
  }
  ImuSample imu_at(double t) const {
    const double along = t > stand && speed_at(t) < speed ? acceleration : 0.0;
    const double latitude = origin.latitude * M_PI / 180.0;
    ImuSample sample;
    const Eigen::Matrix3d attitude =
        Eigen::AngleAxisd(heading_at(t), Eigen::Vector3d::UnitZ()).toRotationMatrix();
    const Eigen::Vector3d earth = attitude.transpose() * earth_rate_enu(latitude);
    sample.angular_velocity = Eigen::Vector3d(0.0, 0.0, yaw_rate_at(t)) + earth;
    const Eigen::Vector3d coriolis = 2.0 * earth_rate_enu(latitude).cross(velocity_at(t));
    sample.specific_force =
        Eigen::Vector3d(along, speed_at(t) * yaw_rate_at(t), 0.0) +
        attitude.transpose() *
            (coriolis + Eigen::Vector3d(0.0, 0.0, normal_gravity(latitude, origin.altitude)));
    return sample;
  }

 private:
  double known_until_ = 0.0;
  Eigen::Vector3d known_ = Eigen::Vector3d::Zero();
};

/// What a drive's sensors say.
struct DriveNoise {
  double imu_rate = 100.0;  ///< [Hz]
  double fix_period = 1.0;  ///< [s]
  double fix = 0.02;        ///< [m]
  double velocity = 0.05;   ///< [m/s]
  double gyro = 1e-3;       ///< [rad/s/sqrt(Hz)]
  double accel = 2e-2;      ///< [m/s^2/sqrt(Hz)]
  Eigen::Vector3d gyro_bias{0.002, -0.001, 0.003};
  double fix_late = 0.0;  ///< [s] of the fixes' stamps after the truth
};

/// Events of the drive's first `length` seconds, in order of their stamps.
inline std::vector<Event> sense(KnownDrive drive, double length, const DriveNoise& noise, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  const auto vector = [&](double stddev) {
    return Eigen::Vector3d(stddev * normal(random), stddev * normal(random), stddev * normal(random));
  };
  const TangentPlane plane(drive.origin);
  std::vector<Event> events;
  double next_fix = 0.5;
  const int count = static_cast<int>(length * noise.imu_rate);
  for (int i = 0; i < count; ++i) {
    const double t = i / noise.imu_rate;
    while (next_fix <= t) {
      const Eigen::Vector3d place = drive.position_at(next_fix);
      const double stamp = next_fix + noise.fix_late;
      Event fix{at_seconds(stamp), Sensor::kFix,
                PositionFix{plane.to_earth(place + vector(noise.fix)),
                            Eigen::Matrix3d::Identity() * noise.fix * noise.fix, true}};
      Event velocity{at_seconds(stamp), Sensor::kFixVelocity,
                     VelocityFix{drive.velocity_at(next_fix) + vector(noise.velocity),
                                 Eigen::Matrix3d::Identity() * noise.velocity * noise.velocity}};
      events.push_back(fix);
      events.push_back(velocity);
      next_fix += noise.fix_period;
    }
    ImuSample sample = drive.imu_at(t);
    sample.angular_velocity += noise.gyro_bias + vector(noise.gyro * std::sqrt(noise.imu_rate));
    sample.specific_force += vector(noise.accel * std::sqrt(noise.imu_rate));
    events.push_back({at_seconds(t), Sensor::kImu, sample});
  }
  std::stable_sort(events.begin(), events.end(),
                   [](const Event& a, const Event& b) { return a.key() < b.key(); });
  return events;
}

}  // namespace relative_map::core
