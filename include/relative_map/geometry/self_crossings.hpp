#pragma once

#include <vector>

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

/// Where a polyline crosses itself: two segments that are no neighbours, each from its vertex to the next.
struct SelfCrossing {
  std::size_t first = 0, second = 0;  ///< first < second
};

/// All of them, by rising `first`; where it only touches or runs along itself it does not cross.
std::vector<SelfCrossing> self_crossings(const Polyline& points, Ends ends);

}  // namespace relative_map::core
