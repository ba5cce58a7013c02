#include "relative_map/localization/pyramid/pyramid_map.hpp"

#include <algorithm>

namespace relative_map::core {

void Moments::add(double value) {
  count += 1.0;
  const double before = value - mean;
  mean += before / count;
  squares += before * (value - mean);
}

void Moments::add(const Moments& other) {
  // A cell without ground has nothing to add: 0 / 0 must not become its altitude.
  if (!(other.count > 0.0)) return;
  const double sum = count + other.count;
  const double apart = other.mean - mean;
  squares += other.squares + apart * apart * count * other.count / sum;
  mean += apart * other.count / sum;
  count = sum;
}

void PyramidCell::add(const PyramidCell& other) {
  intensity.add(other.intensity);
  altitude.add(other.altitude);
  ground.add(other.ground);
}

PyramidCell& PyramidLevel::at(std::int64_t x, std::int64_t y) {
  const auto next = static_cast<std::int32_t>(cells_.size());
  const VoxelKey key = voxel_key(x, y, 0);
  const std::int32_t found = index_.insert(key, next);
  if (found == next) {
    cells_.emplace_back();
    keys_.push_back(key);
  }
  return cells_[found];
}

const PyramidCell* PyramidLevel::find(std::int64_t x, std::int64_t y) const {
  const std::int32_t found = index_.find(voxel_key(x, y, 0));
  return found < 0 ? nullptr : &cells_[found];
}

PyramidLevel PyramidLevel::merged() const {
  PyramidLevel coarse(2.0 * cell_size_);
  for (std::size_t i = 0; i < cells_.size(); ++i) {
    const auto at = place(i);
    coarse.at(floor_of(0.5 * static_cast<double>(at.x())), floor_of(0.5 * static_cast<double>(at.y())))
        .add(cells_[i]);
  }
  return coarse;
}

PyramidMap::PyramidMap(double cell_size, const Eigen::Vector2d& origin)
    : origin_(origin), levels_{PyramidLevel(cell_size)} {}

void PyramidMap::add(const PointCloud& cloud) {
  PyramidLevel& finest = levels_[0];
  const double reach = static_cast<double>(kVoxelBias - 2) * finest.cell_size();
  VoxelIndex blocks;
  std::vector<double> lowest;
  const auto block_of = [&](const Eigen::Vector2d& local) {
    return voxel_key(floor_of(local.x() / kGroundBlock), floor_of(local.y() / kGroundBlock), 0);
  };
  for (int pass = 0; pass < 2; ++pass) {  // first how low each block is, then the cells
    for (std::size_t i = 0; i < cloud.size(); ++i) {
      const Eigen::Vector3d& point = cloud.points[i];
      const Eigen::Vector2d local = point.head<2>() - origin_;
      if (!(local.cwiseAbs().maxCoeff() < reach) || !point.allFinite()) continue;
      const auto next = static_cast<std::int32_t>(lowest.size());
      const std::int32_t block = blocks.insert(block_of(local), next);
      if (block == next) lowest.push_back(point.z());
      if (pass == 0) {
        lowest[block] = std::min(lowest[block], point.z());
        continue;
      }
      PyramidCell& cell =
          finest.at(floor_of(local.x() / finest.cell_size()), floor_of(local.y() / finest.cell_size()));
      cell.altitude.add(point.z());
      if (cloud.has_intensity()) cell.intensity.add(cloud.intensity[i]);
      if (point.z() < lowest[block] + kGroundBand) cell.ground.add(point.z());
    }
  }
}

void PyramidMap::finish() {
  levels_.resize(1, PyramidLevel(0.0));
  while (levels_.size() < kLevels) levels_.push_back(levels_.back().merged());
}

}  // namespace relative_map::core
