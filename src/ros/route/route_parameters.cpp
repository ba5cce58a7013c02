#include "relative_map/ros/route/route_parameters.hpp"

#include "relative_map/ros/setup/parameter_taker.hpp"

namespace relative_map {

namespace {

void take_route(ParameterTaker& taker, core::RouteParam& route) {
  taker.take("route/max_distance", route.max_distance);
  taker.take("route/max_heading", route.max_heading);
  taker.take("route/look_back", route.look_back);
  taker.take("route/look_ahead", route.look_ahead);
  taker.take("route/look_ahead_fast", route.look_ahead_fast);
  taker.take("route/look_ahead_time", route.look_ahead_time);
  taker.take("route/max_lane_change_distance", route.max_lane_change_distance);
  taker.take("route/lane_gap", route.lane_gap);
  taker.add("route", route.validate());
}

void take_line(ParameterTaker& taker, core::ReferenceLineParam& line) {
  taker.take("reference_line/spacing", line.spacing);
  taker.take("reference_line/vehicle_width", line.vehicle_width);
  taker.take("reference_line/half_width", line.half_width);
  taker.take("reference_line/clearance", line.clearance);
  taker.take("reference_line/curb_clearance", line.curb_clearance);
  taker.take("reference_line/curb_shift", line.curb_shift);
  taker.take("reference_line/least_bound", line.least_bound);
  taker.take("reference_line/greatest_bound", line.greatest_bound);
  taker.take("reference_line/follow", line.follow);
  taker.take("reference_line/pinned", line.pinned);
  taker.take("reference_line/speed_limit", line.speed_limit);
  taker.take("reference_line/lateral_acceleration", line.lateral_acceleration);
  taker.add("reference_line", line.validate());
}

void take_search(ParameterTaker& taker, core::SearchParam& search) {
  taker.take("search/base_speed", search.base_speed);
  taker.take("search/left_turn", search.left_turn);
  taker.take("search/right_turn", search.right_turn);
  taker.take("search/u_turn", search.u_turn);
  taker.take("search/lane_change", search.lane_change);
  taker.take("search/lane_change_length", search.lane_change_length);
  taker.take("search/least_change_length", search.least_change_length);
  taker.take("search/min_turn_radius", search.min_turn_radius);
  taker.add("search", search.validate());
}

void take_lane_change(ParameterTaker& taker, core::LaneChangeParam& change) {
  taker.take("lane_change/least_length", change.least_length);
  taker.take("lane_change/duration", change.duration);
  taker.take("lane_change/timeout", change.timeout);
  taker.take("lane_change/done_offset", change.done_offset);
  taker.add("lane_change", change.validate());
}

}  // namespace

RouteNodeConfig make_route_config(const ParameterSet& parameters) {
  RouteNodeConfig config;
  ParameterTaker taker(parameters);
  taker.take("source", config.source,
             {{"lane_graph", RouteSource::kLaneGraph}, {"relative_map", RouteSource::kRelativeMap}});
  taker.take("orientation_convention", config.orientation_convention,
             {{"flu", OrientationConvention::kFlu}, {"rfu", OrientationConvention::kRfu}});
  taker.take("rate", config.rate);
  taker.take("lane_graph", config.lane_graph);
  taker.take("base_frame", config.base_frame);
  taker.take("max_age/localization", config.max_age_localization);
  taker.take("max_age/chassis", config.max_age_chassis);
  taker.take("max_age/relative_map", config.max_age_relative_map);
  taker.expect("rate", config.rate, 0.1, 1000.0);
  taker.expect("max_age/localization", config.max_age_localization, 0.01, 1e9);
  taker.expect("max_age/chassis", config.max_age_chassis, 0.01, 1e9);
  taker.expect("max_age/relative_map", config.max_age_relative_map, 0.01, 1e9);
  if (config.base_frame.empty()) taker.faults.push_back("base_frame must not be empty");
  take_route(taker, config.route);
  take_line(taker, config.reference_line);
  take_search(taker, config.search);
  take_lane_change(taker, config.lane_change);
  taker.finish();
  return config;
}

}  // namespace relative_map
