#pragma once

#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/route_index.hpp"
#include "relative_map/route/route_param.hpp"
#include "relative_map/route/route_tracker.hpp"

namespace relative_map::core {

/// The own passage of a vehicle, and the one that it has to change to if it can from here; never empty.
std::vector<RouteSegments> segments_around(const RouteIndex& index, const RouteParam& param,
                                           const TrackedPlace& place, const Pose2& pose, double speed);

}  // namespace relative_map::core
