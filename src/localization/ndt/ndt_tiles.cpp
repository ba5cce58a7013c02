#include "relative_map/localization/ndt/ndt_tiles.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace relative_map::core {

namespace {

/// [m] from a place to the nearest point of a tile.
double distance_to(const NdtMapInfo& info, const TileKey& key, const Eigen::Vector3d& place) {
  const Eigen::Vector2d from_corner = (place - info.corner(key)).head<2>();
  const Eigen::Vector2d outside =
      (from_corner.array() - from_corner.array().max(0.0).min(info.tile_size)).matrix();
  return outside.norm();
}

}  // namespace

std::vector<NdtTile> cut_into_tiles(const NdtStatistics& statistics, NdtMapInfo& info) {
  std::map<TileKey, NdtTile> tiles;
  for (const VoxelMoments& voxel : statistics.voxels()) {
    const TileKey key{static_cast<int>(std::floor(voxel.mean.x() / info.tile_size)),
                      static_cast<int>(std::floor(voxel.mean.y() / info.tile_size))};
    NdtTile& tile = tiles[key];
    tile.key = key;
    const Eigen::Vector3d corner(key.x * info.tile_size, key.y * info.tile_size, 0.0);
    tile.voxels.push_back({voxel.count, voxel.mean - corner, voxel.scatter});
  }
  info.tiles.clear();
  std::vector<NdtTile> result;
  for (auto& [key, tile] : tiles) {
    info.tiles.push_back(key);
    result.push_back(std::move(tile));
  }
  return result;
}

NdtTileWindow::NdtTileWindow(NdtMapInfo info, double radius, std::size_t most_voxels, Reader reader)
    : info_(std::move(info)), radius_(radius), most_voxels_(most_voxels), reader_(std::move(reader)) {}

const NdtTile& NdtTileWindow::tile(const TileKey& key) {
  used_.remove(key);
  used_.push_back(key);
  const auto found = tiles_.find(key);
  if (found != tiles_.end()) return found->second;
  NdtTile tile;
  try {
    tile = reader_(key);
  } catch (const std::runtime_error& fault) {
    if (faults_.size() < 100) faults_.push_back(fault.what());
  }
  tile.key = key;
  voxels_ += tile.voxels.size();
  return tiles_[key] = std::move(tile);
}

NdtMapPair NdtTileWindow::around(const Eigen::Vector3d& place) {
  std::vector<TileKey> needed;
  for (const TileKey& key : info_.tiles) {
    if (distance_to(info_, key, place) <= radius_) needed.push_back(key);
  }
  if (needed.empty()) return {};
  NdtStatistics statistics(info_.resolution, info_.corner(needed.front()));
  for (const TileKey& key : needed) {
    const Eigen::Vector3d shift = info_.corner(key) - statistics.origin();
    for (const NdtTileVoxel& voxel : tile(key).voxels) {
      statistics.add(VoxelMoments{voxel.count, voxel.mean + shift, voxel.scatter});
    }
  }
  while (voxels_ > most_voxels_ && used_.size() > needed.size()) {
    const auto oldest = tiles_.find(used_.front());
    voxels_ -= oldest->second.voxels.size();
    tiles_.erase(oldest);
    used_.pop_front();
  }
  return make_ndt_maps(statistics);
}

}  // namespace relative_map::core
