#pragma once

#include <Eigen/Core>
#include <string>
#include <tuple>
#include <vector>

namespace relative_map::core {

/// Which tile of a map: its corner lies at (x, y) times the tiles' size from the map's origin.
struct TileKey {
  int x = 0, y = 0;
  friend bool operator<(const TileKey& a, const TileKey& b) {
    return std::tie(a.x, a.y) < std::tie(b.x, b.y);
  }
  friend bool operator==(const TileKey& a, const TileKey& b) { return a.x == b.x && a.y == b.y; }
};

/// The points of a voxel: number, mean and sum of squared deviations.
struct NdtTileVoxel {
  double count = 0.0;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();     ///< [m] relative to the tile's corner
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();  ///< [m^2]
};

struct NdtTile {
  TileKey key;
  std::vector<NdtTileVoxel> voxels;
};

/// What all tiles of a map have in common, and which there are.
struct NdtMapInfo {
  std::string frame_id = "map";
  double resolution = 1.0;  ///< [m] edge of a voxel
  double tile_size = 50.0;  ///< [m] edge of a tile, a whole number of voxels of twice the resolution
  Eigen::Vector3d origin = Eigen::Vector3d::Zero();  ///< [m] in frame_id
  std::vector<TileKey> tiles;                        ///< in their order

  Eigen::Vector3d corner(const TileKey& key) const {
    return origin + Eigen::Vector3d(key.x * tile_size, key.y * tile_size, 0.0);
  }
};

}  // namespace relative_map::core
