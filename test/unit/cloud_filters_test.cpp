#include "relative_map/localization/clouds/cloud_filters.hpp"

#include <gmock/gmock.h>

#include <limits>
#include <random>

#include "relative_map/localization/clouds/deskew.hpp"

namespace relative_map::core {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

PointCloud cloud_of(const std::vector<Eigen::Vector3d>& points) {
  PointCloud cloud;
  cloud.points = points;
  return cloud;
}

TEST(CropTest, KeepsWhatIsNeitherNearNorFarNorNothing) {
  const PointCloud cloud = cloud_of({{0.5, 0, 0}, {1, 0, 0}, {0, 60, 80}, {0, 60, 80.1}, {kNan, 2, 2}});
  const PointCloud kept = crop(cloud, 1.0, 100.0);
  ASSERT_EQ(kept.size(), 2u);
  EXPECT_EQ(kept.points[1], Eigen::Vector3d(0, 60, 80));
}

TEST(VoxelFilterTest, AVoxelBecomesItsMean) {
  PointCloud cloud = cloud_of({{0.1, 0.1, 0.1}, {0.3, 0.1, 0.1}, {5, 5, 5}, {kNan, 0, 0}, {1e30, 0, 0}});
  cloud.intensity = {1, 3, 7, 9, 9};
  const PointCloud few = voxel_filter(cloud, 0.5);
  ASSERT_EQ(few.size(), 2u);
  EXPECT_LT((few.points[0] - Eigen::Vector3d(0.2, 0.1, 0.1)).norm(), 1e-12);
  EXPECT_EQ(few.intensity, (std::vector<double>{2, 7}));
  EXPECT_EQ(voxel_filter(cloud, 0.0).size(), cloud.size());
  EXPECT_TRUE(voxel_filter(PointCloud(), 0.5).empty());
}

TEST(VoxelFilterTest, AMillionPointsLeaveOneForEachVoxel) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> number(0.0, 10.0);
  PointCloud cloud;
  for (int i = 0; i < 1'000'000; ++i) cloud.points.emplace_back(number(random), number(random), 0.0);
  EXPECT_NEAR(static_cast<double>(voxel_filter(cloud, 0.5).size()), 420.0, 21.0);  // 20 x 20, cut edges
}

/// A sensor that drives a bend of 10 m/s and 1 rad/s.
Eigen::Isometry3d bend(double t) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  pose.translation() = Eigen::Vector3d(10.0 * std::sin(t), 10.0 * (1.0 - std::cos(t)), 1.0);
  return pose;
}

TEST(DeskewTest, ASweepInABendBecomesTheWorldAgain) {
  PointCloud sweep, world;
  for (int i = 0; i < 200; ++i) {
    const double t = 0.0005 * i;
    const Eigen::Vector3d place(20.0 + 0.1 * i, 5.0 - 0.05 * i, 0.3);
    sweep.points.push_back(bend(t).inverse() * place);
    sweep.time.push_back(t);
    world.points.push_back(bend(0.1).inverse() * place);
  }
  std::vector<TimedPose> poses;
  for (int i = 0; i <= 10; ++i) poses.push_back({0.01 * i, bend(0.01 * i)});
  std::string fault;
  const PointCloud result = deskewed(sweep, poses, 0.1, 0.02, fault);
  EXPECT_EQ(fault, "");
  double worst = 0.0, before = 0.0;
  for (int i = 0; i < 200; ++i) {
    worst = std::max(worst, (result.points[i] - world.points[i]).norm());
    before = std::max(before, (sweep.points[i] - world.points[i]).norm());
  }
  EXPECT_LT(worst, 2e-4);  // the bend between two poses is flattened: v w dt^2 / 8
  EXPECT_GT(before, 2.0);
}

TEST(DeskewTest, WhatItLacksItSays) {
  PointCloud cloud = cloud_of({{1, 2, 3}});
  std::string fault;
  deskewed(cloud, {{0.0, bend(0)}, {1.0, bend(1)}}, 0.5, 0.0, fault);
  EXPECT_EQ(fault, "the points have no times");
  cloud.time = {2.0};
  EXPECT_EQ(deskewed(cloud, {{0.0, bend(0)}, {1.0, bend(1)}}, 0.5, 0.1, fault).points[0], cloud.points[0]);
  EXPECT_EQ(fault, "the points' times reach beyond the poses'");
  deskewed(cloud, {{0.0, bend(0)}}, 0.5, 0.1, fault);
  EXPECT_EQ(fault, "there are fewer than two poses to carry the points by");
  deskewed(cloud, {{1.0, bend(0)}, {1.0, bend(0)}}, 0.5, 10.0, fault);
  EXPECT_EQ(fault, "the poses are not in the order of their times");
  deskewed(PointCloud(), {}, 0.5, 0.1, fault);
  EXPECT_EQ(fault, "");
}

}  // namespace
}  // namespace relative_map::core
