#pragma once

#include <string>

#include "relative_map/model/lane_graph.hpp"
#include "relative_map/model/route.hpp"

// Lane graphs and routes in JSON files; doc/route.md has the keys.
//   lane graph  {"frame_id", "map_version", "lanes": [{"id", "centerline": [[x, y]...], "left_width",
//               "right_width": [[s, half width]...], "successors", "predecessors", "left_neighbors",
//               "right_neighbors", "left_reverse", "right_reverse": [id...], "left_paint", "right_paint":
//               [[s, type]...], "speed_limit", "type", "turn", "road", "junction"}...]}
//   route       {"roads": [{"id", "passages": [{"segments": [{"id", "start_s", "end_s"}...], "can_exit",
//               "change_lane_type"}...]}...], "waypoints": [{"id", "s"[, "x", "y"]}...], "distance"}
// Metres, radians, m/s. What is not named is not known; keys that are not named here are skipped.
namespace relative_map::core {

/// Reads a lane graph. Throws std::runtime_error, one sentence that names the file, the lane and the fault,
/// if the file can't be read, is no JSON, or has something that is not of its kind. Whether the lanes make
/// sense is not looked at.
LaneGraph read_lane_graph(const std::string& path);
/// Writes it whole or not at all, see write_whole_file().
void write_lane_graph(const std::string& path, const LaneGraph& graph);

/// The same for a route.
Route read_route(const std::string& path);
/// A route as JSON text, one line.
std::string route_text(const Route& route);

/// "dotted_white" and such; throws std::runtime_error for a name that is none.
BoundaryType boundary_type_of(const std::string& name);
const char* name_of(BoundaryType type);

}  // namespace relative_map::core
