#pragma once

#include <string>
#include <vector>

#include "relative_map/localization/inertial_filter/inertial_param.hpp"
#include "relative_map/model/geo_reference.hpp"

namespace relative_map::core {

enum class Method { kRtk, kInertial, kPlanar };

/// [s] added to stamps: negative where a sensor's messages are stamped late.
struct StampOffsets {
  double imu = 0.0, fix = 0.0, fix_velocity = 0.0, heading = 0.0, wheels = 0.0, map_pose = 0.0;
};

/// Noise of what does not say its own. One standard deviation.
struct AssumedNoise {
  double fix = 0.0;           ///< [m] horizontally; 0: by the kind of fix
  double fix_velocity = 0.1;  ///< [m/s]
  double heading = 0.02;      ///< [rad]
};

/// How the planar method takes the vehicle to move.
struct PlanarParam {
  double acceleration = 1.0;      ///< [m/s^2/sqrt(Hz)] that the speed changes by
  double yaw_acceleration = 0.5;  ///< [rad/s^2/sqrt(Hz)] that the yaw rate changes by
  double yaw_rate_stddev = 0.01;  ///< [rad/s] of the wheels' yaw rate
  double yaw_rate_bias = 0.01;    ///< [rad/s] that it may be wrong by all the time
  double slip = 0.05;             ///< [m/sqrt(s)] sideways
};

/// `rtk/...`: how fixes and inertial samples are put together.
struct RtkParam {
  double max_wait = 0.02;       ///< [s] that a fix waits for the inertial sample after it
  double max_bracket = 0.05;    ///< [s] between the two samples around a fix
  double max_imu_age = 0.1;     ///< [s] of the newest sample
  double course_speed = 1.0;    ///< [m/s] from which on the course is the heading
  double ok_stddev = 0.1;       ///< [m] horizontally, of a fixed solution
  double warning_stddev = 0.5;  ///< [m]
};

struct LocalizerParam {
  Method method = Method::kInertial;
  InertialParam inertial;
  PlanarParam planar;
  RtkParam rtk;
  StampOffsets stamp_offset;
  AssumedNoise assumed;
  double rate = 100.0;              ///< [Hz] of estimates, at most
  GeoReference reference;           ///< of the map; without a projection it is the first fix's UTM zone
  bool local_at_first_fix = false;  ///< and with this a plane tangent there

  std::vector<std::string> validate() const;
};

}  // namespace relative_map::core
