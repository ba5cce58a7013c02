#include "relative_map/localization/ndt/ndt_map.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace relative_map::core {

namespace {

constexpr double kLeastVariance = 1e-6;  // [m^2] of points that are all the same

/// The inverse covariance, and its smallest eigenvalue.
std::pair<Eigen::Matrix3d, double> regularised_information(const VoxelMoments& voxel) {
  const Eigen::Matrix3d covariance = voxel.scatter / (voxel.count - 1.0);
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(covariance);
  const double largest = std::max(solver.eigenvalues()[2], kLeastVariance);
  const Eigen::Vector3d variances = solver.eigenvalues().cwiseMax(NdtMap::kLeastEigenvalueShare * largest);
  return {solver.eigenvectors() * variances.cwiseInverse().asDiagonal() * solver.eigenvectors().transpose(),
          1.0 / largest};
}

std::array<VoxelKey, 7> direct7(VoxelKey key) {
  const Eigen::Matrix<std::int64_t, 3, 1> at = voxel_of(key);
  const std::int64_t x = at.x(), y = at.y(), z = at.z();
  return {key,
          voxel_key(x - 1, y, z),
          voxel_key(x + 1, y, z),
          voxel_key(x, y - 1, z),
          voxel_key(x, y + 1, z),
          voxel_key(x, y, z - 1),
          voxel_key(x, y, z + 1)};
}

}  // namespace

NdtMap::NdtMap(const NdtStatistics& statistics)
    : resolution_(statistics.resolution()),
      inverse_resolution_(1.0 / statistics.resolution()),
      origin_(statistics.origin()) {
  std::vector<std::array<VoxelKey, 7>> places;
  for (std::size_t i = 0; i < statistics.voxels().size(); ++i) {
    const VoxelMoments& voxel = statistics.voxels()[i];
    if (voxel.count < kLeastPoints) continue;
    const auto [information, least] = regularised_information(voxel);
    voxels_.push_back({{voxel.mean.x(), voxel.mean.y(), voxel.mean.z()},
                       {information(0, 0), information(0, 1), information(0, 2), information(1, 1),
                        information(1, 2), information(2, 2)},
                       least});
    places.push_back(direct7(statistics.keys()[i]));
  }
  std::vector<std::uint32_t> counts;
  for (const auto& around : places) {
    for (const VoxelKey key : around) {
      const auto next = static_cast<std::int32_t>(counts.size());
      const std::int32_t at = index_.insert(key, next);
      if (at == next) counts.push_back(0);
      ++counts[at];
    }
  }
  starts_.assign(counts.size() + 1, 0);
  for (std::size_t i = 0; i < counts.size(); ++i) starts_[i + 1] = starts_[i] + counts[i];
  neighbours_.resize(starts_.back());
  std::vector<std::uint32_t> next(starts_.begin(), starts_.end() - 1);
  for (std::size_t voxel = 0; voxel < places.size(); ++voxel) {
    for (const VoxelKey key : places[voxel]) {
      neighbours_[next[index_.find(key)]++] = static_cast<std::uint32_t>(voxel);
    }
  }
}

}  // namespace relative_map::core
