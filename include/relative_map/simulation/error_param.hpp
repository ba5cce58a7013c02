#pragma once

#include <string>
#include <vector>

namespace relative_map::core {

// Errors that last, on top of the white noise of NoiseParam; all of them are off by default.

/// Time that passes between two episodes of a fault, and how long each lasts.
struct EpisodeParam {
  double interval = 0.0;  ///< [s] mean time from one's end to the next one's start; 0: there are none
  double min_duration = 0.0, max_duration = 0.0;  ///< [s]
};

/// Of a pose that is summed up from motion, as wheels and gyro, or SLAM between its closed loops, do it:
/// right at the start of the drive, and wrong by more and more.
struct PoseDriftParam {
  double distance_scale = 0.0;  ///< [-] standard deviation of the share by which ways are too long
  double turn_scale = 0.0;      ///< [-] standard deviation of the share by which turns are too large
  double heading_walk = 0.0;    ///< [rad/sqrt(m)] random walk of the heading by distance driven
  double closed_after = 0.0;    ///< [s] on average, when a closed loop puts the pose right again; 0: never
  /// Also the yaw rate's bias and scale and the chassis' speed scale: the pose is made of these sensors.
  bool dead_reckoned = false;

  bool active() const {
    return dead_reckoned || distance_scale > 0.0 || turn_scale > 0.0 || heading_walk > 0.0;
  }
};

struct LocalizationErrorParam {
  double bias = 0.0;                ///< [m] standard deviation in map x and in map y
  double bias_time = 30.0;          ///< [s] over which a bias is forgotten
  double heading_bias = 0.0;        ///< [rad] standard deviation
  double heading_bias_time = 30.0;  ///< [s]
  double drift = 0.0;               ///< [m] reached after drift_time, in a direction that the seed gives
  double drift_time = 100.0;        ///< [s]
  double yaw_rate_bias = 0.0;       ///< [rad/s] greatest; constant over a drive
  double yaw_rate_scale = 0.0;  ///< [-] greatest share by which yaw rates are wrong; constant over a drive
  EpisodeParam jump;            ///< the position jumps aside, stays there for a while, and jumps back
  double min_jump = 0.0, max_jump = 0.0;  ///< [m]
  PoseDriftParam pose_drift;
};

struct ChassisErrorParam {
  double speed_scale = 0.0;  ///< [-] greatest share of the speed by which it is wrong; constant over a drive
};

/// Of a recorded line, sideways.
struct RecordingErrorParam {
  double offset = 0.0;          ///< [m] standard deviation of what is the same all along
  double wander = 0.0;          ///< [m] standard deviation of what changes along the line
  double wander_length = 60.0;  ///< [m] over which it does
};

struct MarkerErrorParam {
  double correlated_share = 0.0;  ///< [0, 1] of the noise's variance that lasts from image to image ...
  double correlation_time = 1.0;  ///< ... for so long [s]
  double common_share = 0.0;      ///< [0, 1] of the noise's variance that all paint of an image has in common
  double view_range_change = 0.0;  ///< [m] standard deviation of the view range about PaintParam::view_range
  double view_range_time = 10.0;   ///< [s] over which it changes
  double min_view_range = 25.0, max_view_range = 70.0;  ///< [m] limits of the changing view range
  EpisodeParam dropout{0.0, 0.2, 3.0};                  ///< one side, or both, is not seen
  EpisodeParam outlier{0.0, 0.1, 1.0};    ///< one side, or both, is taken for other paint, at full quality
  double min_jump = 1.5, max_jump = 3.5;  ///< [m] between the paint and that which it is taken for
  double min_latency = 0.0, max_latency = 0.0;  ///< [s] from the image to the message
  double yaw = 0.0;      ///< [rad] by which the camera looks to the left, unknown to it
  double lateral = 0.0;  ///< [m] by which it sits to the left, likewise
  double nearest = 0.0;  ///< [m] nothing nearer is seen
  EpisodeParam blind;    ///< no paint at all is seen
};

struct ErrorParam {
  LocalizationErrorParam localization;
  ChassisErrorParam chassis;
  RecordingErrorParam recording;
  MarkerErrorParam markers;

  /// Every fault as one sentence that names the parameter and its value.
  std::vector<std::string> validate() const;
};

}  // namespace relative_map::core
