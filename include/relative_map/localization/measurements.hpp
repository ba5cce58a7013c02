#pragma once

#include <Eigen/Core>
#include <limits>
#include <tuple>
#include <variant>

#include "relative_map/model/geo_reference.hpp"
#include "relative_map/model/time.hpp"

namespace relative_map::core {

constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();

/// What an inertial sensor says, in FLU axes of the body (or its own, where that is said).
struct ImuSample {
  Eigen::Vector3d angular_velocity = Eigen::Vector3d::Zero();  ///< [rad/s] with its bias
  Eigen::Vector3d specific_force = Eigen::Vector3d::Zero();    ///< [m/s^2] at rest: gravity, upwards
};

/// A place on the earth, of the antenna or of the body's origin.
struct PositionFix {
  GeoPoint place;                                        ///< its altitude is given
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2] east, north, up
  bool fixed = false;  ///< of a receiver that says it corrects its carrier phase (RTK)
};

/// How the antenna moves, seen from the earth.
struct VelocityFix {
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();    ///< [m/s] east, north, up there
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();  ///< [m^2/s^2]
};

/// Which way the body points.
struct HeadingFix {
  double heading = 0.0;  ///< [rad] of the x axis, counter-clockwise from true east
  double stddev = 0.0;   ///< [rad]
};

/// What the wheels say of the rear axle.
struct WheelSpeed {
  double speed = 0.0;           ///< [m/s] forward positive
  double yaw_rate = kNotGiven;  ///< [rad/s] left positive; NaN: not given
  bool sign_known = true;       ///< false: it is a magnitude
};

/// The sources, in the order in which those of one time are used.
enum class Sensor { kImu, kWheels, kFix, kFixVelocity, kHeading, kMapPosition, kMapHeading };
constexpr int kSources = 7;

/// One measurement, at the time that it holds for.
struct Event {
  Time stamp{};
  Sensor source = Sensor::kImu;
  std::variant<ImuSample, WheelSpeed, PositionFix, VelocityFix, HeadingFix> data;

  /// There is one measurement of a source at a time.
  std::tuple<Time, Sensor> key() const { return {stamp, source}; }
};

}  // namespace relative_map::core
