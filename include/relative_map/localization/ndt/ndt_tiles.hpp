#pragma once

#include <functional>
#include <list>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "relative_map/localization/ndt/ndt_matcher.hpp"
#include "relative_map/model/ndt_tile.hpp"

namespace relative_map::core {

/// Cuts a map into its tiles; `info.tiles` is filled. `statistics` must have the map's origin and resolution.
std::vector<NdtTile> cut_into_tiles(const NdtStatistics& statistics, NdtMapInfo& info);

/// The part of a map around the vehicle. Tiles are kept while there is room, the longest unused go first.
class NdtTileWindow {
 public:
  /// Reads a tile; may throw std::runtime_error, which is kept as a fault, and the tile is as if empty.
  using Reader = std::function<NdtTile(const TileKey&)>;

  /// `radius` [m] of what is needed around the vehicle; at most `most_voxels` are kept in memory, about 90
  /// bytes each, but never fewer than the window needs.
  NdtTileWindow(NdtMapInfo info, double radius, std::size_t most_voxels, Reader reader);

  /// The grids of all tiles within the radius around a place in the map's frame; null grids where there is no
  /// tile. Reads files: not for a thread that must not wait.
  NdtMapPair around(const Eigen::Vector3d& place);

  const NdtMapInfo& info() const { return info_; }
  std::size_t tiles_in_memory() const { return tiles_.size(); }
  std::size_t voxels_in_memory() const { return voxels_; }
  /// Of tiles that could not be read.
  const std::vector<std::string>& faults() const { return faults_; }

 private:
  const NdtTile& tile(const TileKey& key);

  NdtMapInfo info_;
  double radius_;
  std::size_t most_voxels_;
  Reader reader_;
  std::map<TileKey, NdtTile> tiles_;
  std::list<TileKey> used_;  ///< the last used one last
  std::size_t voxels_ = 0;
  std::vector<std::string> faults_;
};

}  // namespace relative_map::core
