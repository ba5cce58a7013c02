#pragma once

#include <Eigen/Core>
#include <vector>

#include "relative_map/localization/clouds/voxel_grid.hpp"

namespace relative_map::core {

/// Number, mean and scatter (sum of squared deviations) of the points in a voxel: all that its normal
/// distribution is made of, and two of them add up to that of all their points (Chan et al., 1979).
struct VoxelMoments {
  double count = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< [m] relative to the grid's origin
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< [m^2]

  void add(const Eigen::Vector3d& point);
  void add(const VoxelMoments& other);
};

/// The moments of all voxels of a grid, of few points, too: a map in the making.
class NdtStatistics {
 public:
  /// `resolution` [m] is the edge of a voxel, `origin` [m] the grid's: coordinates are kept relative to it.
  NdtStatistics(double resolution, const Eigen::Vector3d& origin);

  /// A point in the map's frame; one that is not finite or beyond the grid (a million voxels) is left out.
  void add(const Eigen::Vector3d& point);
  /// Moments relative to this grid's origin; they go to the voxel that their mean lies in.
  void add(const VoxelMoments& moments);

  /// The same points in voxels `factor` times as large.
  NdtStatistics coarsened(int factor) const;

  double resolution() const { return resolution_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  const std::vector<VoxelMoments>& voxels() const { return voxels_; }
  const std::vector<VoxelKey>& keys() const { return keys_; }

 private:
  VoxelMoments& at(VoxelKey key);

  double resolution_;
  Eigen::Vector3d origin_;
  VoxelIndex index_;
  std::vector<VoxelKey> keys_;
  std::vector<VoxelMoments> voxels_;
};

}  // namespace relative_map::core
