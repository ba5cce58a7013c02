#pragma once

#include <string>
#include <vector>

#include "relative_map/model/road_users.hpp"

namespace relative_map::core {

/// A broken row of what planners may rely on, with the road user and the numbers.
struct PredictionFault {
  std::string row;
  std::string what;
};

/// The names of all rows, in the order in which they are checked.
std::vector<std::string> prediction_check_rows();

/// Every fault of one trajectory that starts where a road user is.
std::vector<PredictionFault> check_trajectory(const PredictedRoadUser& user,
                                              const PredictedTrajectory& trajectory);

/// Every broken row of a prediction, the first fault of each; empty: it may be published.
std::vector<PredictionFault> check_prediction(const Prediction& prediction);

}  // namespace relative_map::core
