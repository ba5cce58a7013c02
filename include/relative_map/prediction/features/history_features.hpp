#pragma once

#include <Eigen/Core>

#include "relative_map/prediction/road_user.hpp"

namespace relative_map::core {

constexpr int kHistorySteps = 20;  ///< of 0.1 s

/// Where a road user was in the last two seconds, for networks: in its own frame (x where it drives to),
/// newest first.
struct HistoryFeatures {
  Eigen::Matrix<double, kHistorySteps, 2> positions;  ///< [m] from where it is now
  Eigen::Matrix<double, kHistorySteps, 2> steps;      ///< [m] from each to the next newer one; the first is 0
  int given = 0;                                      ///< rows that were seen; the others are 0
};

/// As it was seen, in between on the straight line.
HistoryFeatures history_features(const RoadUser& user);

}  // namespace relative_map::core
