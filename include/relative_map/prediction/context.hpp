#pragma once

#include <vector>

#include "relative_map/model/prediction_config.hpp"
#include "relative_map/model/road_users.hpp"
#include "relative_map/prediction/situation.hpp"

namespace relative_map::core {

/// What all evaluators and predictors of one prediction look at.
struct PredictionContext {
  Time now{};
  const PredictionConfig& config;
  const LaneView& lanes;
  const EgoVehicle& ego;
  const SpeedProfile& ego_profile;           ///< how fast the vehicle goes on
  const std::vector<LanePlace>& ego_places;  ///< lanes around the vehicle
  const std::vector<Situation>& situations;  ///< of all road users
};

}  // namespace relative_map::core
