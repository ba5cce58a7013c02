#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/MapMsg.h>
#include <visualization_msgs/MarkerArray.h>

#include "relative_map/model/config.hpp"

namespace relative_map {

/// Draws maps for rviz: lanes filled, boundaries in their paint, perceived markers, footprint, status text.
/// Each array starts by deleting what the last one drew, so nothing is left behind.
class MapMarkers {
 public:
  visualization_msgs::MarkerArray draw(const MapMsg& map, const core::Footprint& footprint) const;
};

/// The current lane's centerline; empty in an empty map.
nav_msgs::Path centerline(const MapMsg& map);

}  // namespace relative_map
