#pragma once

#include <string>

#include "relative_map/model/map.hpp"
#include "relative_map/model/route_segments.hpp"

namespace relative_map::core {

/// A relative map as a route: its lanes are the passages of one road, and the best of them is where it leads.
struct RelativeMapRoute {
  RouteUpdate update;        ///< all lanes: the own one first, then by how many lane changes away they are
  std::string current_lane;  ///< that the vehicle is on
  std::string target_lane;   ///< the best one that lane changes lead to
};

/// The segments on a relative map, seen from its origin. The own lane is the map's current one; where that is
/// not named, the nearest within 10 m. The own lane and the next one towards the target are to be driven on
/// (is_on_segment, is_neighbor); priority counts lane changes. A map without a lane is refused with its
/// own status. A lane that no change leads to comes last, with the side that it lies on.
RelativeMapRoute route_on_relative_map(const RelativeMap& map);

}  // namespace relative_map::core
