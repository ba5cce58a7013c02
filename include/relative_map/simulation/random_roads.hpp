#pragma once

#include <cstdint>

#include "relative_map/simulation/road.hpp"

namespace relative_map::core {

// Roads whose curves the seed gives, `length` [m] long or a little longer. They wind about one direction, and
// do not cross themselves.

/// Somewhere in the map, in map-sized coordinates.
Pose2 random_start(std::uint64_t seed);

/// Radii from 600 m on.
RoadShape motorway_road(std::uint64_t seed, double length);
/// Radii of 80 to 300 m.
RoadShape country_road(std::uint64_t seed, double length);
/// Blocks: corners of 90 degrees with radii from 12 m on, and bends of 40 to 80 m between some of them.
RoadShape urban_road(std::uint64_t seed, double length);

}  // namespace relative_map::core
