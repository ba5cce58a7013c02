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
/// An old town: corners of 50 to 110 degrees with radii of 4 to 15 m, and slight bends between some of them.
RoadShape town_road(std::uint64_t seed, double length);
/// Straights of 150 to 350 m, and bends with radii of 25 to 60 m between them: seldom a hint of where along
/// the road one is, and then it matters.
RoadShape long_straights_road(std::uint64_t seed, double length);

}  // namespace relative_map::core
