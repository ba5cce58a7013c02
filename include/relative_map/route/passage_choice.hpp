#pragma once

#include <optional>

#include "relative_map/route/route_index.hpp"

namespace relative_map::core {

/// The passage beside the vehicle's own that it has to change to, to go on along the route: the next one of
/// the road, in the route's order, with a lane that is a direct neighbor on the side of the change; where
/// there is none after it, the nearest one before it. None where no change is needed, or where a waypoint on
/// the own passage comes first. A vehicle that turns back is on the passage before, which then is its own.
std::optional<std::size_t> next_passage(const RouteIndex& index, const PiecePlace& place);

/// Where a vehicle can change from its own passage to another one of the road, seen from its place: from the
/// first of its lanes ahead that has a lane of the other beside it, to the end of the last one of them. None
/// if there is none ahead.
std::optional<ChangeZone> change_zone(const RouteIndex& index, const PiecePlace& place,
                                      std::size_t to_passage);

}  // namespace relative_map::core
