#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/localization/ndt/ndt_covariance.hpp"
#include "relative_map/localization/ndt/ndt_matcher.hpp"

namespace relative_map::core {

/// What else is known of a place.
struct NdtExpectation {
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
  std::optional<Matrix6> guess_covariance;  ///< of a step as in stepped(); none: the guess is anybody's
  std::optional<double> usual_likelihood;   ///< at this place, in good matches of before
};

/// A result, how well it is known, and whether it is to be believed.
struct NdtVerdict {
  bool believed = false;
  std::vector<std::string> reasons;  ///< why not, a sentence each; empty if it is believed
  std::vector<std::string> remarks;  ///< what holds though it is believed: weak directions
  double likelihood = 0.0;  ///< [0, 1] mean over all points of the best voxel's score, over the largest
  double overlap = 0.0;     ///< [0, 1] share of points in or beside a voxel
  double upright_likelihood = 0.0;  ///< [0, 1] the likelihood of the points that are not on the ground alone
  NdtCovariance uncertainty;
};

/// The points on walls, poles, trees and vehicles: those well above the lowest one of their column of 1 m, z
/// up. The ground looks alike everywhere; they tell one place from another.
std::vector<Eigen::Vector3d> upright_points(const std::vector<Eigen::Vector3d>& points);

/// A score alone does not tell a right pose from a wrong one: see doc/localization_lidar.md.
NdtVerdict judge(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                 const NdtAlignment& alignment, const NdtExpectation& expected, const NdtBeliefParam& param);

}  // namespace relative_map::core
