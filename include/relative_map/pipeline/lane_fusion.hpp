#pragma once

#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/lane_marker_path.hpp"

namespace relative_map::core {

/// Pulls the current lane towards the markers by a fixed weight [0, 1] and returns what was applied.
/// Both are aligned by arc length from the vehicle. Behind the first paint the correction settles to what it
/// is there and holds; past the last it fades to zero over `fade_length` [m]: both smooth in heading and
/// curvature. The path keeps its number of points; s, theta, kappa and dkappa are those of the result.
FusionState fuse_fixed_weight(const MarkerPath& markers, double weight, double fade_length, LanePath& lane);

}  // namespace relative_map::core
