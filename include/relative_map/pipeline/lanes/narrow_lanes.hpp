#pragma once

#include <string>
#include <vector>

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

/// Takes out lanes, or the rest of a lane, that a better one leaves no room for: beside it the vehicle does
/// not fit between the borders, or they cross. The lane that the vehicle is in, `lanes[current]`, is the best
/// of all, and loses nothing; the others rank by priority. Roads that run elsewhere beside the vehicle are no
/// lanes of this one. Returns a sentence for each that loses something. Lanes come in any order and leave
/// left to right; `half_width` [m] is the vehicle's.
std::vector<std::string> make_room(std::vector<LanePath>& lanes, std::size_t& current, double half_width);

/// Ends a lane before `s` [m]; false leaves it as it is: what remained of it ahead of the vehicle would be
/// too short.
bool cut_short(LanePath& lane, double s);

}  // namespace relative_map::core
