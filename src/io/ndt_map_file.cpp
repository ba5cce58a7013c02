#include "relative_map/io/ndt_map_file.hpp"

#include <array>
#include <boost/crc.hpp>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "relative_map/io/whole_file.hpp"

namespace relative_map::core {

namespace {

namespace fs = std::filesystem;

constexpr const char* kFormat = "relative_map ndt map";
constexpr int kVersion = 1;
constexpr char kMagic[8] = {'R', 'M', 'A', 'P', 'N', 'D', 'T', '1'};
constexpr std::size_t kLargestTile = std::size_t{256} << 20;  // [bytes]
constexpr std::size_t kNumbers = 10;                          // count, mean, upper half of the scatter

/// As it stands in the file, before the voxels. Little-endian, as all systems that ROS 1 runs on.
struct TileHeader {
  char magic[8];
  std::int32_t x, y;
  double resolution, tile_size;
  std::uint64_t voxels;
  std::uint32_t checksum;  ///< CRC-32 of the voxels
  std::uint32_t unused;
};
static_assert(sizeof(TileHeader) == 48);

std::string index_path(const std::string& folder) {
  return (fs::path(folder) / "map.json").string();
}

std::string tile_path(const std::string& folder, const TileKey& key) {
  const std::string name = "tile_" + std::to_string(key.x) + "_" + std::to_string(key.y) + ".ndt";
  return (fs::path(folder) / name).string();
}

std::uint32_t checksum_of(const char* bytes, std::size_t count) {
  boost::crc_32_type crc;
  crc.process_bytes(bytes, count);
  return crc.checksum();
}

}  // namespace

void expect_ndt_map_writable(const std::string& folder, bool replace) {
  std::error_code error;
  if (fs::exists(folder, error)) {
    if (!fs::is_directory(folder, error)) throw std::runtime_error(folder + ": is no folder");
    if (!fs::is_empty(folder, error)) {
      if (!replace) throw std::runtime_error(folder + ": is not empty; --replace replaces an older map");
      const NdtMapInfo old = read_ndt_map_info(folder);  // nothing but a map is replaced
      fs::remove(index_path(folder), error);
      for (const TileKey& key : old.tiles) fs::remove(tile_path(folder, key), error);
    }
  }
  fs::create_directories(folder, error);
  if (error) throw std::runtime_error(folder + ": can't be made: " + error.message());
  expect_writable(index_path(folder));
}

void write_ndt_tile(const std::string& folder, const NdtMapInfo& info, const NdtTile& tile) {
  std::string bytes;
  bytes.reserve(tile.voxels.size() * kNumbers * sizeof(double));
  for (const NdtTileVoxel& voxel : tile.voxels) {
    const Eigen::Matrix3d& s = voxel.scatter;
    const std::array<double, kNumbers> numbers = {voxel.count, voxel.mean.x(), voxel.mean.y(), voxel.mean.z(),
                                                  s(0, 0),     s(0, 1),        s(0, 2),        s(1, 1),
                                                  s(1, 2),     s(2, 2)};
    bytes.append(reinterpret_cast<const char*>(numbers.data()), sizeof(numbers));
  }
  TileHeader header = {};
  std::memcpy(header.magic, kMagic, sizeof(kMagic));
  header.x = tile.key.x;
  header.y = tile.key.y;
  header.resolution = info.resolution;
  header.tile_size = info.tile_size;
  header.voxels = tile.voxels.size();
  header.checksum = checksum_of(bytes.data(), bytes.size());
  write_whole_file(tile_path(folder, tile.key),
                   std::string(reinterpret_cast<const char*>(&header), sizeof(header)) + bytes);
}

void write_ndt_map_info(const std::string& folder, const NdtMapInfo& info) {
  nlohmann::json json = {
      {"format", kFormat},           {"version", kVersion},
      {"frame_id", info.frame_id},   {"resolution", info.resolution},
      {"tile_size", info.tile_size}, {"origin", {info.origin.x(), info.origin.y(), info.origin.z()}}};
  json["tiles"] = nlohmann::json::array();
  for (const TileKey& key : info.tiles) json["tiles"].push_back({key.x, key.y});
  write_whole_file(index_path(folder), json.dump(1) + "\n");
}

NdtMapInfo read_ndt_map_info(const std::string& folder) {
  const std::string path = index_path(folder);
  const std::string content = read_whole_file(path);
  try {
    const nlohmann::json json = nlohmann::json::parse(content);
    if (json.at("format") != kFormat) throw std::runtime_error("it is of another kind");
    if (json.at("version") != kVersion) throw std::runtime_error("its version is not 1");
    NdtMapInfo info;
    info.frame_id = json.at("frame_id");
    info.resolution = json.at("resolution");
    info.tile_size = json.at("tile_size");
    for (int i = 0; i < 3; ++i) info.origin[i] = json.at("origin").at(i);
    for (const auto& tile : json.at("tiles")) info.tiles.push_back({tile.at(0), tile.at(1)});
    const bool sound = info.resolution >= 0.5 && info.tile_size >= info.resolution && info.tile_size < 1e5 &&
                       info.origin.allFinite();
    if (!sound) throw std::runtime_error("its sizes make no sense");
    return info;
  } catch (const std::exception& fault) {
    throw std::runtime_error(path + ": is no index of an NDT map: " + fault.what());
  }
}

NdtTile read_ndt_tile(const std::string& folder, const NdtMapInfo& info, const TileKey& key) {
  const std::string path = tile_path(folder, key);
  const std::string content = read_whole_file(path, kLargestTile);
  TileHeader header = {};
  if (content.size() < sizeof(header)) throw std::runtime_error(path + ": is cut off");
  std::memcpy(&header, content.data(), sizeof(header));
  if (std::memcmp(header.magic, kMagic, sizeof(kMagic)) != 0) {
    throw std::runtime_error(path + ": is no tile of an NDT map, or of another version");
  }
  if (header.x != key.x || header.y != key.y || header.resolution != info.resolution ||
      header.tile_size != info.tile_size) {
    throw std::runtime_error(path + ": is a tile of another map, or of another place");
  }
  const std::size_t size = content.size() - sizeof(header);
  constexpr std::size_t kVoxel = kNumbers * sizeof(double);
  if (size % kVoxel != 0 || header.voxels != size / kVoxel) throw std::runtime_error(path + ": is cut off");
  const char* place = content.data() + sizeof(header);
  if (checksum_of(place, size) != header.checksum) {
    throw std::runtime_error(path + ": is damaged: its checksum is wrong");
  }
  NdtTile tile;
  tile.key = key;
  tile.voxels.resize(header.voxels);
  for (NdtTileVoxel& voxel : tile.voxels) {
    std::array<double, kNumbers> n;
    std::memcpy(n.data(), place, sizeof(n));
    place += sizeof(n);
    voxel.count = n[0];
    voxel.mean = Eigen::Vector3d(n[1], n[2], n[3]);
    voxel.scatter << n[4], n[5], n[6], n[5], n[7], n[8], n[6], n[8], n[9];
  }
  return tile;
}

}  // namespace relative_map::core
