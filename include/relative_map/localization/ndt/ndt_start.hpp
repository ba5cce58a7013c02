#pragma once

#include <string>
#include <vector>

#include "relative_map/localization/ndt/ndt_belief.hpp"

namespace relative_map::core {

/// Where a place is searched from nothing but a rough position.
struct NdtStartRequest {
  Eigen::Isometry3d around = Eigen::Isometry3d::Identity();  ///< its roll, pitch and z are taken as good
  double radius = 5.0;                                       ///< [m] of positions that are tried
  double yaw_range = 3.141592653589793;  ///< [rad] to either side; by default the full circle
};

struct NdtStart {
  bool reliable = false;
  std::string why_not;  ///< a sentence; empty if it is reliable
  NdtAlignment best;
  NdtVerdict verdict;
  double runner_up = 0.0;  ///< [0, 1] likelihood of the best other place, over that of the best
  int candidates = 0;      ///< that were looked at
};

/// Looks at a lattice of positions and directions on the coarse grid, aligns the best ones, and takes that
/// which is believed and clearly better than any other place. A lattice is enough: NDT finds from 1 m and 10
/// degrees what lies between its knots, and the same input always gives the same answer.
NdtStart find_start(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                    const NdtStartRequest& request, const NdtMatchParam& match, NdtBeliefParam belief);

}  // namespace relative_map::core
