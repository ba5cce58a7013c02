#pragma once

#include "relative_map/localization/ndt/ndt_param.hpp"
#include "relative_map/localization/ndt/ndt_score.hpp"

namespace relative_map::core {

/// How well a result is known.
struct NdtCovariance {
  /// Of a step as in stepped(): x y z [m], then turns about the target's x y z [rad].
  Matrix6 covariance = Matrix6::Identity();
  double condition = 0.0;   ///< [-] least information over the largest, rotations by their lever
  int weak_directions = 0;  ///< of six: those in which the surroundings hardly tell the place
  Vector6 weakest =
      Vector6::Zero();  ///< the direction of least information; rotations times their levers [m]
};

/// I^-1 S I^-1: the inverse of the information, scaled by how much the gradients of the voxels really scatter
/// (Huber's sandwich). Weak directions are widened to `weak_stddev`, all to at least the least standard
/// deviations.
NdtCovariance ndt_covariance(const NdtInformation& found, const NdtBeliefParam& param);

}  // namespace relative_map::core
