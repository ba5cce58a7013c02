#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/MapMsg.h>
#include <visualization_msgs/MarkerArray.h>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/config.hpp"

namespace relative_map {

/// Draws maps for rviz: lanes filled in their priority's colour, the current one strongest; boundaries in
/// their paint; perceived markers; the current lane's line as recorded, `raw_line`, in the body frame;
/// footprint; status text. Each array starts by deleting what the last one drew, so nothing is left behind.
class MapMarkers {
 public:
  visualization_msgs::MarkerArray draw(const MapMsg& map, const core::Footprint& footprint,
                                       const core::Polyline& raw_line = {}) const;
};

/// The current lane's centerline; empty in an empty map.
nav_msgs::Path centerline(const MapMsg& map);

}  // namespace relative_map
