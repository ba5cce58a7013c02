// Maps in tiles: as files, as a window around the vehicle, and the search for the first place in them.
#include "relative_map/localization/ndt/ndt_tiles.hpp"

#include <gmock/gmock.h>

#include <random>

#include "relative_map/io/ndt_map_file.hpp"
#include "relative_map/io/whole_file.hpp"
#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/ndt/ndt_start.hpp"
#include "support/lidar_rooms.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::fault_of;
using test::pose;
using test::yard;
using testing::HasSubstr;

class NdtTilesTest : public test::TemporaryFolder {
 protected:
  /// A map where UTM coordinates are, of the yard.
  NdtMapInfo write_map(const std::string& name) {
    NdtMapInfo info;
    info.frame_id = "utm";
    info.resolution = 1.0;
    info.tile_size = 20.0;
    info.origin = Eigen::Vector3d(587100.0, 4141200.0, 0.0);
    NdtStatistics statistics(info.resolution, info.origin);
    for (const Eigen::Vector3d& point : transformed(yard(1), truth_).points) statistics.add(point);
    expect_ndt_map_writable(path(name), false);
    for (const NdtTile& tile : cut_into_tiles(statistics, info)) write_ndt_tile(path(name), info, tile);
    write_ndt_map_info(path(name), info);
    voxels_ = statistics.voxels().size();
    return info;
  }
  NdtTileWindow window(const std::string& name, double radius, std::size_t most) {
    const NdtMapInfo info = read_ndt_map_info(path(name));
    return NdtTileWindow(info, radius, most, [folder = path(name), info](const TileKey& key) {
      return read_ndt_tile(folder, info, key);
    });
  }

  const Eigen::Isometry3d truth_ = pose(587123.4, 4141240.6, 35.0, 0.0, 0.0, 0.7);
  std::size_t voxels_ = 0;
};

TEST_F(NdtTilesTest, WhatIsWrittenIsReadAgain) {
  const NdtMapInfo written = write_map("map");
  const NdtMapInfo read = read_ndt_map_info(path("map"));
  EXPECT_EQ(read.frame_id, "utm");
  EXPECT_EQ(read.origin, written.origin);
  EXPECT_EQ(read.tiles, written.tiles);
  EXPECT_GT(read.tiles.size(), 6u);
  NdtTileWindow all = window("map", 500.0, 1'000'000);
  const NdtMapPair maps = all.around(truth_.translation());
  EXPECT_EQ(all.voxels_in_memory(), voxels_) << "no voxel lies in two tiles";
  EXPECT_TRUE(all.faults().empty());
  // It is the map that the points make without tiles, but for rounding.
  NdtStatistics direct(1.0, written.origin);
  for (const Eigen::Vector3d& point : transformed(yard(1), truth_).points) direct.add(point);
  const NdtMapPair expected = make_ndt_maps(direct);
  ASSERT_EQ(maps.fine->voxels().size(), expected.fine->voxels().size());
  const std::vector<Eigen::Vector3d> points = voxel_filter(yard(2), 0.5).points;
  const NdtMixture mixture(1.0);
  EXPECT_NEAR(ndt_score_only(*maps.fine, mixture, points, truth_, 1),
              ndt_score_only(*expected.fine, mixture, points, truth_, 1), 1e-3);
}

TEST_F(NdtTilesTest, TheWindowKeepsToItsMemory) {
  write_map("map");
  NdtTileWindow small = window("map", 15.0, 1);
  small.around(truth_.translation());
  const std::size_t near = small.tiles_in_memory();
  EXPECT_LT(near, small.info().tiles.size());
  const NdtMapPair elsewhere = small.around(truth_.translation() + Eigen::Vector3d(20.0, 15.0, 0.0));
  EXPECT_LE(small.tiles_in_memory(), 9u) << "no more than the window itself needs";
  EXPECT_NE(elsewhere.fine, nullptr);
  EXPECT_EQ(small.around(Eigen::Vector3d(0, 0, 0)).fine, nullptr) << "no tile within a thousand kilometres";
}

TEST_F(NdtTilesTest, DamagedFilesAreToldAndTheRestServes) {
  const NdtMapInfo info = write_map("map");
  const TileKey key = info.tiles[3];
  const std::string file = path("map/tile_") + std::to_string(key.x) + "_" + std::to_string(key.y) + ".ndt";
  const std::string whole = read_whole_file(file);
  const auto said = [&](const std::string& content) {
    write_whole_file(file, content);
    return fault_of([&] { read_ndt_tile(path("map"), info, key); });
  };
  std::string flipped = whole;
  flipped[whole.size() / 2] ^= 1;
  EXPECT_THAT(said(flipped), HasSubstr("checksum"));
  EXPECT_THAT(said(whole.substr(0, whole.size() - 8)), HasSubstr("cut off"));
  EXPECT_THAT(said(whole.substr(0, 20)), HasSubstr("cut off"));
  EXPECT_THAT(said("x" + whole.substr(1)), HasSubstr("another version"));
  NdtTileWindow rest = window("map", 500.0, 1'000'000);
  EXPECT_NE(rest.around(truth_.translation()).fine, nullptr);
  EXPECT_EQ(rest.faults().size(), 1u);
  EXPECT_EQ(said(whole), "");
  NdtMapInfo other = info;
  other.resolution = 2.0;
  EXPECT_THAT(fault_of([&] { read_ndt_tile(path("map"), other, key); }), HasSubstr("another map"));
  write_whole_file(path("map/map.json"), "{}");
  EXPECT_THAT(fault_of([&] { read_ndt_map_info(path("map")); }), HasSubstr("no index"));
}

TEST_F(NdtTilesTest, NothingButAMapIsReplaced) {
  write_map("map");
  EXPECT_THAT(fault_of([&] { expect_ndt_map_writable(path("map"), false); }), HasSubstr("not empty"));
  EXPECT_EQ(fault_of([&] { expect_ndt_map_writable(path("map"), true); }), "");
  std::filesystem::create_directory(path("photos"));
  write("photos/cat.jpg", "cat");
  EXPECT_NE(fault_of([&] { expect_ndt_map_writable(path("photos"), true); }), "");
  EXPECT_TRUE(std::filesystem::exists(path("photos/cat.jpg")));
}

TEST(NdtStartTest, ThePlaceIsFoundFromAnyDirection) {
  const Eigen::Isometry3d truth = pose(3.0, -2.0, 0.0, 0, 0, -2.4);
  const NdtMapPair maps = make_ndt_maps(transformed(yard(1), truth).points, 1.0);
  const std::vector<Eigen::Vector3d> points = voxel_filter(yard(2), 1.0).points;
  NdtStartRequest request;  // 3.6 m away and pointing anywhere
  const NdtStart start = find_start(maps, points, request, NdtMatchParam(), NdtBeliefParam());
  EXPECT_TRUE(start.reliable) << start.why_not;
  const Eigen::Isometry3d error = truth.inverse() * start.best.target_from_source;
  EXPECT_LT(error.translation().norm(), 0.03);
  EXPECT_LT(Eigen::AngleAxisd(error.linear()).angle(), 0.003);
  EXPECT_LT(start.runner_up, 0.7);
}

TEST(NdtStartTest, TwoPlacesThatAreAlikeAreNotReliable) {
  // A room that looks the same turned by half a circle.
  PointCloud half = yard(3), room = half;
  const PointCloud turned = transformed(half, pose(0, 0, 0, 0, 0, 3.14159265));
  for (std::size_t i = 0; i < turned.size(); ++i) room.push_back(turned, i);
  const NdtMapPair maps = make_ndt_maps(room.points, 1.0);
  PointCloud again = yard(4);
  const PointCloud other = transformed(again, pose(0, 0, 0, 0, 0, 3.14159265));
  for (std::size_t i = 0; i < other.size(); ++i) again.push_back(other, i);
  const std::vector<Eigen::Vector3d> points = voxel_filter(again, 1.0).points;
  const NdtStart start = find_start(maps, points, NdtStartRequest(), NdtMatchParam(), NdtBeliefParam());
  EXPECT_FALSE(start.reliable);
  EXPECT_THAT(start.why_not, HasSubstr("alike"));
}

TEST(NdtStartTest, AnotherPlaceIsNotReliable) {
  const NdtMapPair maps = make_ndt_maps(test::corridor(1).points, 1.0);
  const std::vector<Eigen::Vector3d> points = voxel_filter(yard(2), 1.0).points;
  const NdtStart start = find_start(maps, points, NdtStartRequest(), NdtMatchParam(), NdtBeliefParam());
  EXPECT_FALSE(start.reliable);
  EXPECT_NE(start.why_not, "");
  EXPECT_FALSE(find_start(maps, {}, NdtStartRequest(), NdtMatchParam(), NdtBeliefParam()).reliable);
}

}  // namespace
}  // namespace relative_map::core
