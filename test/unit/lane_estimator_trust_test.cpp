// Paint that LaneEstimator must not believe.
#include <gtest/gtest.h>

#include <cmath>

#include "support/straight_drive.hpp"

namespace relative_map::core {
namespace {

using test::kStep;
using test::StraightDrive;

class Outlier : public testing::TestWithParam<double> {};

TEST_P(Outlier, OnOneSideIsLeftOut) {
  StraightDrive drive;
  drive.bias = {0.0, 0.3};
  drive.drive(20);
  for (int i = 0; i < 10; ++i) {
    LaneMarkers markers = drive.paint();
    markers.left.cubic.c0 += GetParam();
    const RelativeMap map = drive.tick(markers);
    EXPECT_NEAR(drive.error(map, 10.0), 0.0, 0.03);
    EXPECT_TRUE(drive.scene.remarked("left is ignored"));
  }
}

TEST_P(Outlier, OnBothSidesIsLeftOut) {
  StraightDrive drive;
  drive.drive(20);
  for (int i = 0; i < 5; ++i) {
    LaneMarkers markers = drive.paint();
    markers.left.cubic.c0 += GetParam();
    markers.right.cubic.c0 += GetParam();
    EXPECT_NEAR(drive.error(drive.tick(markers), 10.0), 0.0, 0.03);
  }
}

INSTANTIATE_TEST_SUITE_P(Jumps, Outlier, testing::Values(-3.5, -2.5, -1.5, 1.5, 2.5, 3.5));

TEST(LaneEstimator, PaintOfAnotherLaneDoesNotPullTheLaneOffItsLine) {
  StraightDrive drive;
  for (int i = 0; i < 100; ++i) {
    LaneMarkers markers = drive.paint();
    markers.left.cubic.c0 += 3.5;
    markers.right.cubic.c0 += 3.5;
    EXPECT_NEAR(drive.error(drive.tick(markers), 10.0), 0.0, 1e-9);
  }
  EXPECT_TRUE(drive.scene.remarked("is ignored"));
}

TEST(LaneEstimator, MirroredPaintDoesNotPullTheLaneOffItsLine) {
  StraightDrive drive;
  for (int i = 0; i < 50; ++i) {
    LaneMarkers markers = drive.paint();
    std::swap(markers.left, markers.right);
    EXPECT_NEAR(drive.error(drive.tick(markers), 10.0), 0.0, 1e-9);
  }
  EXPECT_TRUE(drive.scene.remarked("left of right"));
}

TEST(LaneEstimator, PaintFromTheFutureIsNotBelieved) {
  StraightDrive drive;
  drive.bias = {0.0, 0.5};
  for (int i = 0; i < 20; ++i) {
    LaneMarkers markers = drive.paint();
    markers.stamp = drive.scene.now() + from_seconds(5.0);
    drive.scene.pipeline().set_lane_markers(markers);
    EXPECT_NEAR(drive.error(drive.tick(), 10.0), -0.5, 1e-9);
  }
  EXPECT_TRUE(drive.scene.remarked("no pose is known"));
}

TEST(LaneEstimator, FrozenPaintIsFoundOut) {
  StraightDrive drive;
  const LaneMarkers frozen = drive.paint();
  double worst = 0.0;
  for (int i = 0; i < 200; ++i) {
    const double phase = 2.0 * kPi * (drive.x - 10.0) / 60.0;
    drive.y = 0.2 + 0.5 * std::sin(phase);
    drive.heading = std::atan(0.5 * 2.0 * kPi / 60.0 * std::cos(phase));
    const RelativeMap map = drive.tick(frozen);
    if (i > 60) worst = std::max(worst, std::abs(drive.error(map, 10.0)));
  }
  EXPECT_TRUE(drive.scene.remarked("frozen"));
  EXPECT_LT(worst, 0.05);  // localization is exact here
}

TEST(LaneEstimator, ALaneThatWidensToOneSideKeepsItsCenter) {
  for (const double taper : {1.0 / 50.0, 1.0 / 20.0, 1.0 / 10.0}) {
    for (const bool seen_aslant : {true, false}) {  // or only as wider from image to image
      if (!seen_aslant && taper < 0.05) continue;   // too slow to tell the border from the lane
      for (const double side : {1.0, -1.0}) {
        StraightDrive drive;
        drive.drive(20);
        for (double outward = 0.0; outward < 3.0; outward += taper * kStep) {  // up to 6.5 m of lane
          LaneMarkers markers = drive.paint();
          Cubic& border = (side > 0.0 ? markers.left : markers.right).cubic;
          border.c0 += side * outward;
          if (seen_aslant) border.c1 += side * taper;
          const double error = drive.error(drive.tick(markers), 10.0);
          EXPECT_NEAR(error, 0.0, 0.15) << outward;  // of 1.5 m, were it the middle
        }
      }
    }
  }
}

TEST(LaneEstimator, AnOffsetBeyondTheLimitIsNotBelieved) {
  PipelineConfig config;
  config.lane_fusion.max_offset = 0.5;
  StraightDrive drive(config);
  bool told = false;
  for (int i = 0; i < 100; ++i) {
    drive.bias.y() = 0.01 * i;
    const RelativeMap map = drive.tick(drive.paint());
    EXPECT_LT(std::abs(map.fusion.lateral_offset.value), 0.55);
    told = told || drive.scene.remarked("not believed");
  }
  EXPECT_TRUE(told);
}

}  // namespace
}  // namespace relative_map::core
