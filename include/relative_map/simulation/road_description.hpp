#pragma once

#include <string>

#include "relative_map/simulation/road.hpp"

namespace relative_map::core {

/// The road that a text describes: "demo", "closed", or pieces separated by ';', each of them
/// "straight LENGTH", "arc LENGTH [KAPPA]" or "clothoid LENGTH [KAPPA_START] KAPPA_END" in [m] and [1/m],
/// positive to the left; a curvature left out is the one that the piece before ended with.
/// Throws std::invalid_argument with a sentence that names the faulty piece.
RoadShape parse_road(const std::string& text, const Pose2& start = {});

}  // namespace relative_map::core
