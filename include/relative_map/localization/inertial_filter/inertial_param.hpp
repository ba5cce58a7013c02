#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

namespace relative_map::core {

/// How good an inertial sensor is: densities, so that they hold at any rate.
struct ImuNoise {
  double gyro_noise = 2e-3;       ///< [rad/s/sqrt(Hz)]
  double accel_noise = 5e-2;      ///< [m/s^2/sqrt(Hz)] with the vehicle's vibration
  double gyro_bias_walk = 2e-5;   ///< [rad/s/sqrt(s)]
  double accel_bias_walk = 1e-3;  ///< [m/s^2/sqrt(s)]
};

/// `phone`, `low_cost` or `tactical`; throws std::runtime_error for another name.
ImuNoise imu_noise_of_grade(const std::string& grade);

/// What is assumed of the sensors and of the vehicle. One standard deviation each.
struct InertialParam {
  ImuNoise noise;
  double gate_probability = 1e-4;      ///< [-] of refusing a measurement that is right
  bool nhc = true;                     ///< the rear axle rolls where it points (non-holonomic constraint)
  double nhc_lateral = 0.1;            ///< [m/s] of its slip sideways
  double nhc_vertical = 0.1;           ///< [m/s] and of its heave
  double nhc_yaw_rate = 0.3;           ///< [m/s per rad/s] more sideways, turning
  double nhc_min_speed = 1.0;          ///< [m/s] slower, it says nothing
  bool zero_velocity = true;           ///< standing is recognized and used
  double zero_velocity_stddev = 0.02;  ///< [m/s]
  double zero_rate_stddev = 0.002;     ///< [rad/s]
  double still_rate = 0.02;            ///< [rad/s] that means of 0.1 s may span, standing
  double still_force = 0.2;            ///< [m/s^2] likewise
  double wheel_speed_stddev = 0.1;     ///< [m/s]
  double wheel_scale_stddev = 0.03;    ///< [-] of the wheels' circumference
  double mount_stddev = 0.02;          ///< [rad] yaw and pitch of the sensor's mount, as it is given
  double stamp_offset_stddev =
      0.05;                    ///< [s] between the clocks of fixes and inertial sensor; 0: none is looked for
  double course_speed = 2.0;   ///< [m/s] from which on a course tells the heading at the start
  double tilt_stddev = 0.035;  ///< [rad] roll and pitch after alignment
  double yaw_stddev = 0.14;    ///< [rad] yaw likewise, if from the course
  double gyro_bias_stddev = 0.0035;  ///< [rad/s]
  double accel_bias_stddev = 0.2;    ///< [m/s^2]
  bool gnss_only_init = false;       ///< fixes align the filter, and are not used after that
  double ok_stddev = 0.15;           ///< [m] horizontal, up to which the status is OK
  double warning_stddev = 0.3;       ///< [m] and up to which it is WARNING
  double max_yaw_stddev = 0.0524;    ///< [rad] of a status of OK: 3 degrees

  // How things lie in the body, FLU at the rear axle.
  Eigen::Vector3d imu = Eigen::Vector3d::Zero();      ///< [m]
  Eigen::Vector3d antenna = Eigen::Vector3d::Zero();  ///< [m]

  /// Sentences about what can't be; empty: all can.
  std::vector<std::string> validate() const;
};

}  // namespace relative_map::core
