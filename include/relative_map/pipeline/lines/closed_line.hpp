#pragma once

#include "relative_map/pipeline/lines/navigation_lines.hpp"

namespace relative_map::core {

/// Makes a lap of a line whose ends meet, side by side and in heading; false leaves it as it is. `half_width`
/// [m] of its lane: ends that are farther apart do not meet. The line has its arc lengths, geometry and
/// length.
bool stitch(NavigationLine& line, double half_width);

}  // namespace relative_map::core
