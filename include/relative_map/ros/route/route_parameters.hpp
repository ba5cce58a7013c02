#pragma once

#include <string>

#include "relative_map/ros/setup/parameters.hpp"
#include "relative_map/route/lane_change.hpp"
#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_param.hpp"
#include "relative_map/route/route_search.hpp"

namespace relative_map {

enum class RouteSource { kLaneGraph, kRelativeMap };

/// All that the route node can be told. Defaults as in config/route.yaml.
struct RouteNodeConfig {
  RouteSource source = RouteSource::kLaneGraph;
  double rate = 10.0;      ///< [Hz] of the segments on a lane graph; on a relative map one for each map
  std::string lane_graph;  ///< a file to start with; empty: the topic's
  std::string base_frame = "base_link";
  double max_age_localization = 0.5;  ///< [s]
  double max_age_chassis = 1.0;       ///< [s]
  double max_age_relative_map = 0.5;  ///< [s]
  OrientationConvention orientation_convention = OrientationConvention::kFlu;
  core::RouteParam route;
  core::ReferenceLineParam reference_line;
  core::SearchParam search;
  core::LaneChangeParam lane_change;
};

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
RouteNodeConfig make_route_config(const ParameterSet& parameters);

}  // namespace relative_map
