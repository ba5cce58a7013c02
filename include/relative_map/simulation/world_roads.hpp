#pragma once

#include <cstdint>

#include "relative_map/simulation/road.hpp"
#include "relative_map/simulation/world.hpp"

namespace relative_map::core {

/// The road of a kind that a seed gives, at least `length` [m] long.
RoadShape world_road(RoadKind kind, std::uint64_t seed, double length);

/// The other lines beside the lane whose center is l [m] to the left of the road's reference curve, without
/// errors; their priorities are set. The driven lane's own is 1 beside better ones, else 0.
std::vector<RecordedLine> other_lines(OtherLines kind, const RoadShape& road, double l, double spacing,
                                      std::uint64_t seed);

}  // namespace relative_map::core
