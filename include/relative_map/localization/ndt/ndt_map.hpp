#pragma once

#include <Eigen/Core>
#include <array>
#include <memory>
#include <vector>

#include "relative_map/localization/ndt/ndt_statistics.hpp"

namespace relative_map::core {

/// A normal distribution of a voxel's points, as matching needs it.
struct NdtVoxel {
  std::array<double, 3> mean;         ///< [m] relative to the map's origin
  std::array<double, 6> information;  ///< [1/m^2] inverse covariance: xx xy xz yy yz zz
  double least_information;           ///< [1/m^2] its smallest eigenvalue
};

/// Normal distributions of a map's voxels, ready to be matched against; never changes. Voxels of fewer than
/// six points have none; eigenvalues of a covariance are raised to 1 % of the largest (Magnusson
/// 2009, 6.2.2), so that a wall seen by a perfect lidar still has a thickness.
class NdtMap {
 public:
  static constexpr double kLeastPoints = 6.0;
  static constexpr double kLeastEigenvalueShare = 0.01;

  explicit NdtMap(const NdtStatistics& statistics);

  double resolution() const { return resolution_; }
  const Eigen::Vector3d& origin() const { return origin_; }
  const std::vector<NdtVoxel>& voxels() const { return voxels_; }
  bool empty() const { return voxels_.empty(); }

  /// The voxels around a place: that which it lies in and the six that share a face with it ("DIRECT7"),
  /// those of them that are there. As first and one past the last in `neighbours()`.
  struct Range {
    std::uint32_t first = 0, last = 0;
  };
  Range around(VoxelKey key) const {
    const std::int32_t found = index_.find(key);
    return found < 0 ? Range{} : Range{starts_[found], starts_[found + 1]};
  }
  VoxelKey key_of(const Eigen::Vector3d& local) const { return voxel_key(local, inverse_resolution_); }
  /// Indices of voxels.
  const std::vector<std::uint32_t>& neighbours() const { return neighbours_; }

 private:
  double resolution_, inverse_resolution_;
  Eigen::Vector3d origin_;
  std::vector<NdtVoxel> voxels_;
  // Which voxels are around each place is known beforehand: one look-up for a point instead of seven.
  VoxelIndex index_;
  std::vector<std::uint32_t> starts_;
  std::vector<std::uint32_t> neighbours_;
};

}  // namespace relative_map::core
