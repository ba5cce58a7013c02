#pragma once

#include <string>
#include <vector>

#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lines/lanes_in_reach.hpp"

namespace relative_map::core {

/// The lane, or the line, that is nearest to the vehicle, or whose start is, of those that begin ahead.
/// Another one than `current_id` must be nearer by 0.3 m. There must be one.
std::size_t choose_current(const std::vector<LanePath>& lanes, const std::string& current_id);
const TrackedLine& choose_current(const std::vector<TrackedLine>& lines, const std::string& current_id);

/// [m] Half the spacing of the lines beside `current`, where lanes may be that wide; else `otherwise`.
double expected_half_width(const std::vector<TrackedLine>& lines, const TrackedLine& current,
                           const NavigationLaneParam& param, double otherwise);

}  // namespace relative_map::core
