#pragma once

#include <vector>

#include "relative_map/localization/pyramid/pyramid_matcher.hpp"

// The search on one level of a pyramid map: all shifts, in all directions that are to be tried.
namespace relative_map::core {

/// What a shift is worth: mean squared distances of the cells that scan and map have in common.
struct ShiftScore {
  double common = 0.0, intensity = 0.0, altitude = 0.0;
};

/// The best direction of a level, and its shifts.
struct LevelResult {
  ShiftHistogram histogram;
  std::vector<ShiftScore> scores;
  double yaw = 0.0;         ///< [rad] from the pose that the level began with
  double yaw_stddev = 0.0;  ///< [rad]
  double lift = 0.0, coverage = 0.0, intensity_weight = 0.0;
};

Eigen::Isometry3d turned(const Eigen::Isometry3d& pose, double yaw);
/// Standard deviation of the cells' mean intensities.
double spread_of_intensity(const PyramidLevel& level);
/// `reach` [cells] to either side of `pose`, and each of `yaws` [rad] from it. No cell's intensity is known
/// better than to `least`. Counts the candidates in `match`. Empty if no cell of the scan meets the map.
LevelResult search_level(const PyramidMap& map, int level, const PointCloud& scan,
                         const Eigen::Isometry3d& pose, int reach, const std::vector<double>& yaws,
                         PyramidWeighing weighing, double least, const PyramidParam& param,
                         PyramidMatch& match);

}  // namespace relative_map::core
