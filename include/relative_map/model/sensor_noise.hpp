#pragma once

namespace relative_map::core {

/// How wrong each sensor may be, as standard deviations. What the estimator can see for itself it measures
/// (white noise, drift, the camera's noise, how far recordings sway); these are what it starts from. Each
/// number is the upper half of what its class of sensors does, so that an unknown vehicle is believed too
/// little, not too much.
struct LocalizationNoise {
  double position_bias = 1.0;  ///< [m] what stays for minutes: plain GNSS with SBAS 1, RTK 0.02, SLAM 0.3
  double position_walk =
      0.15;  ///< [m] by the root of the time [s]: how fast that changes; measured while paint is seen
  double heading_bias = 0.02;          ///< [rad] mounting of the antennas, grid convergence
  double heading_walk = 0.002;         ///< [rad] by the root of the time [s]
  double least_position_noise = 0.02;  ///< [m] white, of each message: RTK's
  double least_heading_noise = 0.003;  ///< [rad] white: a good dual antenna's
};

struct OdometryNoise {
  double speed_scale = 0.03;  ///< [-] worn and new tyres, loaded and empty
  double speed_scale_walk =
      0.003;  ///< [-] by the root of the time [s]: slip, slopes, filters in the wheel's electronics
  double yaw_rate_bias = 0.01;       ///< [rad/s] an automotive gyroscope before it is calibrated: 0.6 deg/s
  double yaw_rate_bias_walk = 1e-4;  ///< [rad/s] by the root of the time [s]: as it warms
  double yaw_rate_noise =
      0.002;  ///< [rad] by the root of the time [s], far above the angular random walk of a gyroscope
  double yaw_rate_scale =
      0.01;                   ///< [-] by the root of the angle turned [rad]: scale, axes that are not square
  double speed_noise = 0.05;  ///< [m] by the root of the time [s]
  double slip = 0.02;         ///< [m] sideways, by the root of the time [s]: cross-fall, wind
  double slip_in_turns = 0.05;  ///< [m] sideways, by the root of the angle turned [rad]: tyres
};

struct CameraNoise {
  double offset = 0.05;        ///< [m] of a marker's c0, from image to image
  double slope = 0.003;        ///< [rad] of its c1
  double curvature = 6e-5;     ///< [1/m] of its c2
  double mount_offset = 0.07;  ///< [m] sideways, alike in all images for a while
  double mount_yaw = 0.01;     ///< [rad] the same of its direction; half a degree is a common tolerance
  double mount_time = 10.0;    ///< [s] for which errors of the mount, the load and the pitch last
};

struct RoadNoise {
  double recording = 0.3;     ///< [m] of a line from its lane's center, all along: a driver's habit
  double sway = 0.2;          ///< [m] the same, changing along it; measured as paint is passed
  double sway_length = 30.0;  ///< [m] over which it changes
  double half_width = 0.35;   ///< [m] from what is expected: lanes are 2.5 to 5 m wide
};

/// `lane_fusion/noise/...`
struct SensorNoise {
  LocalizationNoise localization;
  OdometryNoise odometry;
  CameraNoise camera;
  RoadNoise road;
};

}  // namespace relative_map::core
