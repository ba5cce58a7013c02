#pragma once

#include <vector>

#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"

namespace relative_map::core {

struct TrackedLine {
  const NavigationLine* line;
  LineProjection projection;
};

/// The lines that the vehicle can be on, and the one of them that it is on.
struct TrackedLines {
  std::vector<TrackedLine> lines;
  std::size_t current = 0;

  const TrackedLine& current_line() const { return lines[current]; }
};

}  // namespace relative_map::core
