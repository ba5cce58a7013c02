#pragma once

#include <string>
#include <vector>

#include "relative_map/model/sensor_noise.hpp"

namespace relative_map::core {

enum class LaneSource { kOfflineGenerated, kPerception };

/// Lanes where nothing better is known.
struct MapParam {
  double default_left_width = 1.75;    ///< [m] half width to the left
  double default_right_width = 1.75;   ///< [m] half width to the right
  double default_speed_limit = 29.06;  ///< [m/s]

  /// [m] where left and right do not matter
  double default_half_width() const { return 0.5 * (default_left_width + default_right_width); }
};

struct NavigationLaneParam {
  LaneSource lane_source = LaneSource::kOfflineGenerated;
  double max_len_from_navigation_line = 250.0;      ///< [m] window of a line
  double min_len_for_navigation_lane = 150.0;       ///< [m] shortest path from markers
  double max_len_for_navigation_lane = 250.0;       ///< [m] longest path from markers
  double ratio_navigation_lane_len_to_speed = 8.0;  ///< [s] path from markers, by speed
  double max_distance_to_navigation_line = 15.0;    ///< [m]
  double min_view_range_to_use_lane_marker = 0.5;   ///< [m]
  double min_lane_marker_quality = 0.5;             ///< [-] below it a marker does not count
  double min_lane_half_width = 1.5;                 ///< [m] of perceived lanes
  double max_lane_half_width = 2.0;  ///< [m] of perceived lanes, and half the widest spacing of neighbours
  double lane_marker_weight = 0.1;   ///< [-] 0: the line alone, 1: the markers alone
};

struct LaneFusionParam {
  std::string method = "estimator";  ///< or "fixed_weight", as the original fuses
  // Of the estimator.
  double max_offset = 30.0;  ///< [m] that the lane may be from where localization puts it
  double decay_time = 30.0;  ///< [s] in which the offset decays to 1/e when no lane markers come
  double hold_time = 10.0;   ///< [s] that a lane from markers alone goes on without them
  SensorNoise noise;
  // Of fixed_weight.
  double fade_length = 50.0;  ///< [m] past view_range the correction fades out over this length
};

/// How old the newest message of an input may be [s]; navigation is latched and does not age.
struct MaxAgeParam {
  double localization = 0.5;
  double chassis = 1.0;
  double lane_markers = 0.5;
};

/// The box around the vehicle, seen from base_link.
struct Footprint {
  double half_width = 0.95;      ///< [m]
  double front_overhang = 3.80;  ///< [m] base_link to the foremost point
  double rear_overhang = 1.00;   ///< [m] base_link to the rearmost point
};

/// All that the pipeline can be told.
struct PipelineConfig {
  MapParam map_param;
  NavigationLaneParam navigation_lane;
  LaneFusionParam lane_fusion;
  MaxAgeParam max_age;
  Footprint footprint;
  bool predict_to_tick = false;          ///< maps are for the tick's time, not for the newest pose's
  std::string base_frame = "base_link";  ///< maps are in this frame
  bool enable_cyclic_rerouting = true;
  bool generate_left_boundary = true;  ///< false: the outermost left boundary is marked virtual

  /// Every fault as one sentence that names the parameter and its value; empty: fit to run with.
  std::vector<std::string> validate() const;
};

}  // namespace relative_map::core
