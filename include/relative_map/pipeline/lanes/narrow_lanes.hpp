#pragma once

#include <string>
#include <vector>

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

/// Takes out lanes, or the rest of a lane, beside which a better one runs so near that the vehicle does not
/// fit between the borders. Returns a sentence for each.
/// `lanes` are ordered left to right; `half_width` [m] is the vehicle's; the lane `kept` counts as the best.
std::vector<std::string> drop_narrow_lanes(std::vector<LanePath>& lanes, double half_width,
                                           const std::string& kept = "");

/// The same after the lane `current` has moved: others may lie too near to where it is now.
std::vector<std::string> keep_room_beside(std::vector<LanePath>& lanes, std::size_t& current,
                                          double half_width);

}  // namespace relative_map::core
