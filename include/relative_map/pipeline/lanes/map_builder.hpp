#pragma once

#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lanes/lane_width.hpp"

namespace relative_map::core {

/// Paint seen beside the current lane between two places along it.
struct SeenPaint {
  BoundaryType left = BoundaryType::kUnknown;
  BoundaryType right = BoundaryType::kUnknown;
  BoundaryType next_left = BoundaryType::kUnknown;   ///< of the lane to the left
  BoundaryType next_right = BoundaryType::kUnknown;  ///< of the lane to the right
  double from = 0.0, to = 0.0;                       ///< [m] s of the lane
};

/// Lanes, boundaries, samples, neighbours and the road around them. `lanes` and `borders` belong together.
/// Names and points move into the map. Leaves stamp, sequence number and status to the caller.
RelativeMap build_map(std::vector<LanePath>& lanes, LaneBorders borders, std::size_t current,
                      const SeenPaint& paint, const PipelineConfig& config);

/// Moves names and points back to where `build_map` has them from.
void take_back(RelativeMap&& map, std::vector<LanePath>& lanes);

}  // namespace relative_map::core
