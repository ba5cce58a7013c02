#pragma once

#include <string>

#include "relative_map/model/ndt_tile.hpp"

namespace relative_map::core {

// A map is a folder: map.json says what and which, and each tile has a file with version and checksum.
// Everything throws std::runtime_error, one sentence with the path.

/// Throws if there is anything in the folder but, with `replace`, such a map. Makes the folder.
void expect_ndt_map_writable(const std::string& folder, bool replace);
void write_ndt_tile(const std::string& folder, const NdtMapInfo& info, const NdtTile& tile);
/// To be written last: a map without it is none.
void write_ndt_map_info(const std::string& folder, const NdtMapInfo& info);

NdtMapInfo read_ndt_map_info(const std::string& folder);
/// Throws, too, where the tile is damaged or of another map.
NdtTile read_ndt_tile(const std::string& folder, const NdtMapInfo& info, const TileKey& key);

}  // namespace relative_map::core
