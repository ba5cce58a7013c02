#include "relative_map/pipeline/lanes/map_method.hpp"

namespace relative_map::core {

std::variant<TrackedLines, Status> Tick::lines_in_reach(const VehicleState& vehicle) const {
  if (config.navigation_lane.lane_source == LaneSource::kPerception) {
    return Status{StatusCode::kMarkersUnusable,
                  "lane_source is PERCEPTION, and the lane markers are unusable"};
  }
  return lines.track(vehicle, config, current_id, remarks);
}

}  // namespace relative_map::core
