#pragma once

#include <vector>

#include "relative_map/prediction/context.hpp"

namespace relative_map::core {

/// Where the vehicle is: at a controlled junction, on a lane, or neither.
Scenario analyze_scenario(const LaneView& lanes, const EgoVehicle& ego,
                          const std::vector<LanePlace>& ego_places, const PriorityParam& param);

/// Sets priority and `interactive` of each. Every rule is asked once, from nothing: what an earlier tick
/// thought of a road user does not matter. IGNORE: nowhere near the vehicle's way. CAUTION: the next ahead of
/// and behind the vehicle on its lanes and on the lanes of its target, who merges into them or crosses them,
/// and pedestrians who are or soon will be beside them; at most max_caution, the nearest. Interactive:
/// vehicles among them whose way leads onto the vehicle's.
void prioritize(std::vector<Situation>& situations, const LaneView& lanes, const EgoVehicle& ego,
                const std::vector<LanePlace>& ego_places, const PriorityParam& param);

}  // namespace relative_map::core
