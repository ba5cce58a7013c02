#pragma once

#include <relative_map/RouteSegmentsArray.h>
#include <visualization_msgs/MarkerArray.h>

#include "relative_map/route/route_index.hpp"

namespace relative_map {

/// Draws what is to be followed, in the frame of the segments: the lanes of the graph around pale, passages
/// beside the own one thin, the own line strong, where the lane change has to be done, the goal and the way
/// points. `index` is the route's; none on a relative map.
visualization_msgs::MarkerArray draw_route(const RouteSegmentsArray& told, const core::RouteIndex* index);

}  // namespace relative_map
