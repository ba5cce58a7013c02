#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

/// The borders of the lanes of a map, from neighbours' spacing and half widths.
struct LaneBorders {
  std::vector<Polyline> left, right;  ///< per lane
  std::vector<bool> left_is_shared;   ///< with the lane before, which is then a neighbour
};

/// Lanes up to twice `max_half_width` [m] apart share the line midway between them, or the paint where it was
/// seen beside one of them; farther apart each keeps its own half width, with a gap between them. `lanes` are
/// ordered left to right, none too narrow.
LaneBorders find_borders(const std::vector<LanePath>& lanes, double max_half_width);

}  // namespace relative_map::core
