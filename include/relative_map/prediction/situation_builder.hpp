#pragma once

#include <vector>

#include "relative_map/prediction/context.hpp"

namespace relative_map::core {

/// What is known of each road user at `now`: motion, lanes around it, and ways on.
std::vector<Situation> build_situations(const std::vector<const RoadUser*>& users, Time now,
                                        const LaneView& lanes, const PredictionConfig& config);

/// Who drives ahead of whom on each way. `ego_places` are the lanes that the vehicle itself is on; its index
/// is the one past the situations.
void find_leaders(std::vector<Situation>& situations, const LaneView& lanes, const EgoVehicle& ego,
                  const std::vector<LanePlace>& ego_places, const SpeedParam& param);

/// How the vehicle itself goes on: as it plans, else at the speed that it has.
SpeedProfile profile_of(const EgoVehicle& ego);

}  // namespace relative_map::core
