#include "relative_map/localization/ndt/ndt_statistics.hpp"

namespace relative_map::core {

void VoxelMoments::add(const Eigen::Vector3d& point) {
  count += 1.0;
  const Eigen::Vector3d before = point - mean;
  mean += before / count;
  scatter += before * (point - mean).transpose();
}

void VoxelMoments::add(const VoxelMoments& other) {
  if (!(other.count > 0.0)) return;
  const double sum = count + other.count;
  const Eigen::Vector3d apart = other.mean - mean;
  scatter += other.scatter + (count * other.count / sum) * apart * apart.transpose();
  mean += (other.count / sum) * apart;
  count = sum;
}

NdtStatistics::NdtStatistics(double resolution, const Eigen::Vector3d& origin)
    : resolution_(resolution), origin_(origin) {}

VoxelMoments& NdtStatistics::at(VoxelKey key) {
  const auto next = static_cast<std::int32_t>(voxels_.size());
  const std::int32_t found = index_.insert(key, next);
  if (found == next) {
    voxels_.emplace_back();
    keys_.push_back(key);
  }
  return voxels_[found];
}

void NdtStatistics::add(const Eigen::Vector3d& point) {
  const Eigen::Vector3d local = point - origin_;
  const double reach = static_cast<double>(kVoxelBias - 2) * resolution_;
  if (!(local.cwiseAbs().maxCoeff() < reach)) return;  // not for NaN either
  at(voxel_key(local, 1.0 / resolution_)).add(local);
}

void NdtStatistics::add(const VoxelMoments& moments) {
  at(voxel_key(moments.mean, 1.0 / resolution_)).add(moments);
}

NdtStatistics NdtStatistics::coarsened(int factor) const {
  NdtStatistics coarse(factor * resolution_, origin_);
  for (const VoxelMoments& voxel : voxels_) coarse.add(voxel);
  return coarse;
}

}  // namespace relative_map::core
