#pragma once

#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lines/tracked_line.hpp"

namespace relative_map::core {

/// Of the lines, the one that the vehicle is on: the nearest, or whose start is, of those that begin ahead,
/// and none that runs another way while one runs along. Another one than `current_id` must be nearer by 0.3
/// m. There must be one.
std::size_t choose_current(const std::vector<TrackedLine>& lines, const std::string& current_id);

/// [m] Half the spacing of the lines that run beside `current`, where lanes may be that wide; else
/// `otherwise`.
double expected_half_width(const std::vector<TrackedLine>& lines, const TrackedLine& current,
                           const NavigationLaneParam& param, double otherwise);

}  // namespace relative_map::core
