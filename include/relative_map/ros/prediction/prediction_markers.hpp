#pragma once

#include <relative_map/PredictionObstacles.h>
#include <visualization_msgs/MarkerArray.h>

namespace relative_map {

/// For rviz: a box and a label for each road user, coloured by its priority, and each trajectory as a ribbon
/// that is as wide as its standard deviation across and as opaque as it is likely.
visualization_msgs::MarkerArray draw(const PredictionObstacles& message);

}  // namespace relative_map
