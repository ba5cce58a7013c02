#pragma once

#include <optional>
#include <string>

#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"

namespace relative_map::core {

/// Ends the trust in markers where they part from the lane: from there on they are another lane's.
/// If that is so beside the vehicle already, they are of no use at all, and a sentence says so.
std::optional<std::string> trust_within_lane(const LanePath& lane, MarkerPath& markers);

/// Pulls the current lane towards the markers by a fixed weight [0, 1] and returns what was applied.
/// Both are aligned by arc length from the vehicle. Behind the first paint the correction settles to what it
/// is there and holds; past the last it fades to zero over `fade_length` [m]: both smooth in heading and
/// curvature. The path keeps its number of points; s, theta, kappa and dkappa are those of the result.
FusionState fuse_fixed_weight(const MarkerPath& markers, double weight, double fade_length, LanePath& lane);

}  // namespace relative_map::core
