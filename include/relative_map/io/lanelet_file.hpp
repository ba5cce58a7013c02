#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/io/line_header.hpp"
#include "relative_map/model/lane_graph.hpp"

namespace relative_map::core {

/// A lane graph out of a Lanelet2 map, and what of the map was not understood: a sentence each.
struct LaneletMap {
  LaneGraph graph;
  std::vector<std::string> remarks;
};

/// Reads a Lanelet2 map (OSM XML): the lanelets that cars may drive on become lanes, with their relation's
/// id.
///   centerline    midway between the bounds; half widths are the distances to them
///   successors    lanelets whose bounds start at the nodes where this one's end
///   neighbors     lanelets that share a bound, in the same or in the other direction
///   paint         of the bounds: type line_thin or line_thick with subtype dashed, solid, solid_solid,
///                 dashed_solid, solid_dashed (as seen across it), curbstone
///   speed limit   regulatory element speed_limit (sign_type or limit), else the tag speed_limit: km/h unless
///   it says mph turn          tag turn_direction one_way=no    one more lane, "-" before its id, in the
///   other direction
/// Points come from the tags local_x and local_y where all nodes have them, else from lat and lon by
/// `reference`; without one by the UTM zone of the map. Throws std::runtime_error, one sentence that names
/// the file and the fault, for what is no OSM file or cut off, for a lanelet without bounds, or a way or node
/// that is referred to, but is not there.
LaneletMap read_lanelet_map(const std::string& path, const std::optional<GeoReference>& reference);

}  // namespace relative_map::core
