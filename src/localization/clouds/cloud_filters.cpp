#include "relative_map/localization/clouds/cloud_filters.hpp"

#include "relative_map/localization/clouds/voxel_grid.hpp"

namespace relative_map::core {

namespace {

constexpr double kFarthest = 1e8;  // [m] no place on earth is so far from a map's origin

}  // namespace

PointCloud crop(const PointCloud& cloud, double nearest, double farthest) {
  PointCloud kept;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const double range = cloud.points[i].norm();
    if (range >= nearest && range <= farthest) kept.push_back(cloud, i);  // no for NaN
  }
  return kept;
}

PointCloud voxel_filter(const PointCloud& cloud, double leaf) {
  if (!(leaf > 0.0)) return cloud;
  PointCloud means;
  std::vector<double> counts;
  VoxelIndex voxels(cloud.size() / 4);
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  const double reach = static_cast<double>(kVoxelBias - 1) * leaf;
  bool found = false;
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    const Eigen::Vector3d& point = cloud.points[i];
    if (!(point.cwiseAbs().maxCoeff() < kFarthest) || !point.allFinite()) continue;
    if (!found) origin = point;
    found = true;
    if (!((point - origin).cwiseAbs().maxCoeff() < reach)) continue;
    const auto next = static_cast<std::int32_t>(means.size());
    const std::int32_t at = voxels.insert(voxel_key(point - origin, 1.0 / leaf), next);
    if (at == next) {
      means.push_back(cloud, i);
      counts.push_back(1.0);
      continue;
    }
    const double share = 1.0 / ++counts[at];
    means.points[at] += share * (point - means.points[at]);
    if (cloud.has_intensity()) means.intensity[at] += share * (cloud.intensity[i] - means.intensity[at]);
    if (cloud.has_time()) means.time[at] += share * (cloud.time[i] - means.time[at]);
  }
  return means;
}

PointCloud transformed(const PointCloud& cloud, const Eigen::Isometry3d& target_from_source) {
  PointCloud result = cloud;
  for (Eigen::Vector3d& point : result.points) point = target_from_source * point;
  return result;
}

}  // namespace relative_map::core
