#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <vector>

#include "relative_map/localization/ndt/ndt_map.hpp"
#include "relative_map/localization/ndt/ndt_param.hpp"
#include "relative_map/localization/ndt/ndt_score.hpp"

namespace relative_map::core {

/// Where an alignment ended.
struct NdtAlignment {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  NdtScore at_end;         ///< derivatives by a step as in stepped()
  int iterations = 0;      ///< Newton steps, those on coarse voxels included
  int evaluations = 0;     ///< of the score with its derivatives
  int oscillations = 0;    ///< steps that turned back
  bool converged = false;  ///< the last step was short enough
};

/// The two grids that one map is matched on.
struct NdtMapPair {
  std::shared_ptr<const NdtMap> fine, coarse;
};
/// `statistics` at the fine resolution; the coarse one is twice it.
NdtMapPair make_ndt_maps(const NdtStatistics& statistics);
/// Of points in the target's frame.
NdtMapPair make_ndt_maps(const std::vector<Eigen::Vector3d>& points, double resolution);

/// Moves the guess uphill on the score: Newton's direction, with the sign of each of the Hessian's
/// eigenvalues put right so that it never leads down, and a step by Moré and Thuente's search. An empty map
/// or cloud gives the guess, not converged.
NdtAlignment align(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                   const Eigen::Isometry3d& guess, const NdtMatchParam& param);

/// How far a rotation of 1 rad moves a typical point [m]: rotations are weighed against translations by it.
double lever_of(const std::vector<Eigen::Vector3d>& points);

}  // namespace relative_map::core
