#pragma once

#include <string>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core {

/// What was read, and how many points were left out because they are not finite (lidars mark a beam without
/// an echo so) or absurdly far (1e8 m).
struct CloudFile {
  PointCloud cloud;
  std::size_t dropped = 0;
};

/// Reads a .pcd file (ascii, binary or binary_compressed; fields x y z of any type, `intensity`, and a time:
/// `time`, `t` or `timestamp`, integers in ns, real numbers in s), or KITTI's .bin (float32 x y z intensity,
/// little-endian). Throws std::runtime_error, one sentence with the path, where the file is neither, is cut
/// off, or its header does not agree with its content. A cloud without any point is no fault.
CloudFile read_point_cloud(const std::string& path);

enum class PcdEncoding { kAscii, kBinary, kBinaryCompressed };

/// Writes x y z, `intensity` if there is one and `time` if there is one, as a whole or not at all.
/// Coordinates are float64 if float32 would be off by more than 0.1 mm.
void write_pcd(const std::string& path, const PointCloud& cloud, PcdEncoding encoding = PcdEncoding::kBinary);
/// KITTI's format; intensity 0 where the cloud has none.
void write_kitti(const std::string& path, const PointCloud& cloud);

}  // namespace relative_map::core
