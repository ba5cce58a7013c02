#pragma once

#include <string>
#include <vector>

#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/route_index.hpp"

namespace relative_map::core {

/// A broken row of what planners may rely on, with the passage and the numbers.
struct RouteViolation {
  std::string row;
  std::string what;
};

/// The names of all rows, in the order in which they are checked.
std::vector<std::string> route_check_rows();

/// Every broken row, the first fault of each; empty: it may be published. `index` is the route's; none where
/// the segments were made from a relative map, and then the rows that need a lane graph are not looked at.
std::vector<RouteViolation> check_route(const RouteUpdate& update, const RouteIndex* index);

/// The update, if it keeps the contract; else one without segments, whose status names rows and numbers.
RouteUpdate checked(RouteUpdate update, const RouteIndex* index);

}  // namespace relative_map::core
