#include "relative_map/ros/setup/reconfigure.hpp"

namespace relative_map {

namespace {

/// The parameters that may change while driving, out of and into the pipeline's configuration.
template <class Copy>
void exchange(Copy copy, RelativeMapConfig& request, core::PipelineConfig& config) {
  copy(request.default_left_width, config.map_param.default_left_width);
  copy(request.default_right_width, config.map_param.default_right_width);
  copy(request.default_speed_limit, config.map_param.default_speed_limit);
  copy(request.min_lane_half_width, config.navigation_lane.min_lane_half_width);
  copy(request.max_lane_half_width, config.navigation_lane.max_lane_half_width);
  copy(request.lane_marker_weight, config.navigation_lane.lane_marker_weight);
  copy(request.min_lane_marker_quality, config.navigation_lane.min_lane_marker_quality);
  copy(request.max_len_from_navigation_line, config.navigation_lane.max_len_from_navigation_line);
  copy(request.max_distance_to_navigation_line, config.navigation_lane.max_distance_to_navigation_line);
}

}  // namespace

RelativeMapConfig reconfigure_view(core::PipelineConfig config) {
  RelativeMapConfig view = RelativeMapConfig::__getDefault__();
  exchange([](double& to, double& from) { to = from; }, view, config);
  return view;
}

core::PipelineConfig with_request(core::PipelineConfig config, RelativeMapConfig request) {
  exchange([](double& from, double& to) { to = from; }, request, config);
  return config;
}

}  // namespace relative_map
