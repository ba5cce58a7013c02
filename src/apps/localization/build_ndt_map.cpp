// Makes an NDT map in tiles out of clouds.
#include <algorithm>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "registration.hpp"
#include "relative_map/io/ndt_map_file.hpp"
#include "relative_map/io/text.hpp"
#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/ndt/ndt_tiles.hpp"

namespace relative_map {
namespace {

constexpr const char* kHelp =
    R"(Usage: rosrun relative_map build_ndt_map FOLDER CLOUD... [OPTION]...

Makes an NDT map out of clouds: FOLDER gets map.json and a file for each tile that has points.
Clouds: .pcd (ascii, binary, binary_compressed; metres) or KITTI's .bin. Without --poses they lie in the map's frame.

  --poses FILE         where the clouds' sensor was: a line for each cloud, in their order, "TIME X Y Z QX QY QZ QW"
                       (TUM's format: m, unit quaternion, map from sensor) or twelve numbers (KITTI's: the upper
                       three rows of map from sensor); lines that begin with # are left out
  --resolution M       [m] edge of a voxel (default 2.0, at least 0.5)
  --tile M             [m] edge of a tile (default 50; made a whole number of two voxels)
  --leaf M             [m] voxel filter of each cloud (default 0.1; 0: none)
  --near M, --far M    [m] with --poses: points nearer to the sensor or farther are left out (default 1, 100)
  --frame NAME         frame_id of the map (default map)
  --replace            an NDT map that is in FOLDER already is replaced; nothing else ever is
Exit codes: 0 done, 1 failed, and what was there is as it was, 2 bad arguments.
)";

std::vector<Eigen::Isometry3d> read_poses(const std::string& path) {
  std::istringstream stream(core::read_text(path));
  std::vector<Eigen::Isometry3d> poses;
  int number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    if (core::trimmed(line).empty() || core::trimmed(line)[0] == '#') continue;
    std::istringstream words(line);
    std::vector<double> n;
    for (std::string word; words >> word;)
      n.push_back(parse_number(path + ", line " + std::to_string(number), word));
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    if (n.size() == 8) {
      const Eigen::Quaterniond q(n[7], n[4], n[5], n[6]);
      if (std::abs(q.norm() - 1.0) > 0.01) {
        throw std::runtime_error(path + ", line " + std::to_string(number) +
                                 ": the quaternion is not of length 1");
      }
      pose.linear() = q.normalized().toRotationMatrix();
      pose.translation() = Eigen::Vector3d(n[1], n[2], n[3]);
    } else if (n.size() == 12) {
      for (int r = 0; r < 3; ++r) {
        for (int c = 0; c < 4; ++c) pose.matrix()(r, c) = n[4 * r + c];
      }
      if (std::abs(pose.linear().determinant() - 1.0) > 0.01) {
        throw std::runtime_error(path + ", line " + std::to_string(number) + ": that is no rotation");
      }
    } else {
      throw std::runtime_error(path + ", line " + std::to_string(number) + ": has " +
                               std::to_string(n.size()) + " numbers, neither 8 nor 12");
    }
    poses.push_back(pose);
  }
  return poses;
}

int run(const std::vector<std::string>& words) {
  const CommandLine line(words, {"--poses", "--resolution", "--tile", "--leaf", "--near", "--far", "--frame"},
                         {"--replace"});
  const std::vector<std::string>& files = line.files(2, 1000000, "FOLDER and clouds");
  core::NdtMapInfo info;
  info.resolution = line.number("--resolution", 2.0, 0.5, 20.0);
  info.tile_size = line.number("--tile", 50.0, 2.0, 5000.0);
  info.tile_size =
      std::max(1.0, std::round(info.tile_size / (2.0 * info.resolution))) * 2.0 * info.resolution;
  info.frame_id = line.text("--frame", "map");
  const double leaf = line.number("--leaf", 0.1, 0.0, 10.0);
  const double nearest = line.number("--near", 1.0, 0.0, 1e4),
               farthest = line.number("--far", 100.0, 1.0, 1e5);
  std::vector<Eigen::Isometry3d> poses;
  if (line.has("--poses")) {
    poses = read_poses(line.text("--poses"));
    if (poses.size() != files.size() - 1) {
      throw std::runtime_error(line.text("--poses") + ": has " + std::to_string(poses.size()) +
                               " poses for " + std::to_string(files.size() - 1) + " clouds");
    }
  }
  std::unique_ptr<core::NdtStatistics> statistics;
  ProgressBar progress;
  std::size_t points = 0;
  for (std::size_t i = 1; i < files.size(); ++i) {
    core::PointCloud cloud = read_cloud(files[i]);
    if (!poses.empty()) cloud = core::transformed(core::crop(cloud, nearest, farthest), poses[i - 1]);
    cloud = core::voxel_filter(cloud, leaf);
    progress.show(static_cast<double>(i) / static_cast<double>(files.size()));
    if (cloud.empty()) continue;
    if (!statistics) {
      info.origin = (cloud.points.front() / info.tile_size).array().floor().matrix() * info.tile_size;
      statistics = std::make_unique<core::NdtStatistics>(info.resolution, info.origin);
    }
    for (const Eigen::Vector3d& point : cloud.points) statistics->add(point);
    points += cloud.size();
  }
  if (!statistics) throw std::runtime_error("the clouds have no points: no map was made");
  const std::vector<core::NdtTile> tiles = core::cut_into_tiles(*statistics, info);
  // Only now, when the map is there: what is replaced must not be lost to a fault in the clouds.
  core::expect_ndt_map_writable(files[0], line.has("--replace"));
  for (const core::NdtTile& tile : tiles) core::write_ndt_tile(files[0], info, tile);
  core::write_ndt_map_info(files[0], info);
  const auto good =
      std::count_if(statistics->voxels().begin(), statistics->voxels().end(),
                    [](const auto& voxel) { return voxel.count >= core::NdtMap::kLeastPoints; });
  std::cout << files[0] << ": " << tiles.size() << " tiles of " << info.tile_size << " m, " << good
            << " voxels of " << info.resolution << " m with six points or more, out of " << points
            << " points\n";
  return 0;
}

}  // namespace
}  // namespace relative_map

int main(int argc, char** argv) {
  return relative_map::run_tool("build_ndt_map", relative_map::kHelp, argc, argv, relative_map::run);
}
