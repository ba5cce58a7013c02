#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/MapMsg.h>

#include <map>
#include <string>

namespace relative_map {

/// Each lane's centerline and borders, by where the lane is: "current", "left_1" (the next one to the left of
/// it), "left_2", "right_1", ..., each followed by "/centerline", "/left_border" or "/right_border". Body
/// frame, at the map's stamp; orientations are those of the way. Lanes beyond a gap are no neighbours, and
/// not among them.
std::map<std::string, nav_msgs::Path> lane_paths(const MapMsg& map);

}  // namespace relative_map
