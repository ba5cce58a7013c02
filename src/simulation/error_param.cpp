#include "relative_map/simulation/error_param.hpp"

#include "relative_map/model/check_range.hpp"

namespace relative_map::core {

namespace {

void check_episode(const std::string& name, const EpisodeParam& episode, std::vector<std::string>& faults) {
  check_range(name + "_interval", episode.interval, 0.0, 1e6, faults);
  check_range(name + "_min_duration", episode.min_duration, 0.0, 1e3, faults);
  check_range(name + "_max_duration", episode.max_duration, episode.min_duration, 1e3, faults);
}

}  // namespace

std::vector<std::string> ErrorParam::validate() const {
  std::vector<std::string> faults;
  check_range("errors/localization_bias", localization.bias, 0.0, 100.0, faults);
  check_range("errors/localization_bias_time", localization.bias_time, 0.01, 1e6, faults);
  check_range("errors/heading_bias", localization.heading_bias, 0.0, 1.0, faults);
  check_range("errors/heading_bias_time", localization.heading_bias_time, 0.01, 1e6, faults);
  check_range("errors/drift", localization.drift, 0.0, 1000.0, faults);
  check_range("errors/drift_time", localization.drift_time, 1.0, 1e6, faults);
  check_range("errors/yaw_rate_bias", localization.yaw_rate_bias, 0.0, 1.0, faults);
  check_range("errors/yaw_rate_scale", localization.yaw_rate_scale, 0.0, 0.5, faults);
  check_episode("errors/jump", localization.jump, faults);
  check_range("errors/jump_min", localization.min_jump, 0.0, 1000.0, faults);
  check_range("errors/jump_max", localization.max_jump, localization.min_jump, 1000.0, faults);
  check_range("errors/distance_scale", localization.pose_drift.distance_scale, 0.0, 0.5, faults);
  check_range("errors/turn_scale", localization.pose_drift.turn_scale, 0.0, 0.5, faults);
  check_range("errors/closed_after", localization.pose_drift.closed_after, 0.0, 1e6, faults);
  check_range("errors/heading_walk", localization.pose_drift.heading_walk, 0.0, 1.0, faults);
  check_range("errors/speed_scale", chassis.speed_scale, 0.0, 0.5, faults);
  check_range("errors/recording_offset", recording.offset, 0.0, 10.0, faults);
  check_range("errors/recording_wander", recording.wander, 0.0, 10.0, faults);
  check_range("errors/recording_wander_length", recording.wander_length, 5.0, 1e6, faults);
  check_range("errors/marker_correlated_share", markers.correlated_share, 0.0, 1.0, faults);
  check_range("errors/marker_correlation_time", markers.correlation_time, 0.01, 1e6, faults);
  check_range("errors/marker_common_share", markers.common_share, 0.0, 1.0, faults);
  check_range("errors/view_range_change", markers.view_range_change, 0.0, 300.0, faults);
  check_range("errors/view_range_time", markers.view_range_time, 0.01, 1e6, faults);
  check_range("errors/min_view_range", markers.min_view_range, 0.0, 300.0, faults);
  check_range("errors/max_view_range", markers.max_view_range, markers.min_view_range, 300.0, faults);
  check_episode("errors/dropout", markers.dropout, faults);
  check_episode("errors/outlier", markers.outlier, faults);
  check_range("errors/min_jump", markers.min_jump, 0.0, 100.0, faults);
  check_range("errors/max_jump", markers.max_jump, markers.min_jump, 100.0, faults);
  check_range("errors/min_latency", markers.min_latency, 0.0, 10.0, faults);
  check_range("errors/max_latency", markers.max_latency, markers.min_latency, 10.0, faults);
  check_range("errors/marker_yaw", markers.yaw, -1.0, 1.0, faults);
  check_range("errors/marker_lateral", markers.lateral, -2.0, 2.0, faults);
  check_range("errors/marker_nearest", markers.nearest, 0.0, 300.0, faults);
  check_episode("errors/blind", markers.blind, faults);
  return faults;
}

}  // namespace relative_map::core
