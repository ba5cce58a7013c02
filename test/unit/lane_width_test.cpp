#include "relative_map/pipeline/lanes/lane_width.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/lanes.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::concentric_lane;
using test::lane;
using test::straight_lane;

constexpr double kMaxHalfWidth = 2.0;  // [m] neighbours are up to 4 m apart

TEST(Borders, OfALaneAloneRunAtItsHalfWidths) {
  LanePath alone = straight_lane("a", 0.5);
  alone.left_half_width = 1.6;
  alone.right_half_width = 1.9;
  const LaneBorders borders = find_borders({alone}, kMaxHalfWidth);
  ASSERT_EQ(borders.left[0].size(), alone.points.size());
  for (std::size_t i = 0; i < alone.points.size(); ++i) {
    EXPECT_NEAR((borders.left[0][i] - alone.points[i].position - Point2(0.0, 1.6)).norm(), 0.0, 1e-12);
    EXPECT_NEAR((borders.right[0][i] - alone.points[i].position - Point2(0.0, -1.9)).norm(), 0.0, 1e-12);
  }
}

TEST(Borders, OfParallelStraightsShareTheMidline) {
  const LaneBorders borders =
      find_borders({straight_lane("left", 3.2), straight_lane("right", 0.0)}, kMaxHalfWidth);
  EXPECT_FALSE(borders.left_is_shared[0]);
  EXPECT_TRUE(borders.left_is_shared[1]);
  for (const Point2& point : borders.right[0]) EXPECT_NEAR(point.y(), 1.6, 2e-3);
  for (const Point2& point : borders.left[1]) EXPECT_NEAR(point.y(), 1.6, 2e-3);
  for (std::size_t i = 1; i + 1 < borders.right[0].size(); ++i) {
    EXPECT_EQ(borders.right[0][i].y(), 1.6) << "to the last digit, but for the ends, where they may part";
    EXPECT_EQ(borders.right[0][i], borders.left[1][i]);
  }
  EXPECT_NEAR(borders.left[0][10].y(), 3.2 + 1.75, 1e-12) << "the outer ones stay";
  EXPECT_NEAR(borders.right[1][10].y(), -1.75, 1e-12);
  for (const Polyline* border : {&borders.right[0], &borders.left[1]}) {
    EXPECT_NEAR(border->front().x(), -2.0, 1e-12) << "from end to end";
    EXPECT_NEAR(border->back().x(), 100.0, 1e-12);
    for (std::size_t i = 1; i < border->size(); ++i) EXPECT_GT((*border)[i].x(), (*border)[i - 1].x());
  }
}

TEST(Borders, OfConcentricArcsShareTheArcBetween) {
  for (const double kappa : {0.02, -0.02}) {
    const LaneBorders borders =
        find_borders({concentric_lane("left", kappa, 3.5), concentric_lane("middle", kappa, 0.0),
                      concentric_lane("right", kappa, -3.5)},
                     kMaxHalfWidth);
    const Point2 center(0.0, 1.0 / kappa);
    const auto expect_radius = [&](const Polyline& border, double offset) {
      for (const Point2& point : border) {
        EXPECT_NEAR((point - center).norm(), std::abs(1.0 / kappa - offset), 2e-3) << "at offset " << offset;
      }
    };
    expect_radius(borders.left[0], 3.5 + 1.75);
    expect_radius(borders.right[0], 1.75);
    expect_radius(borders.left[1], 1.75);
    expect_radius(borders.right[1], -1.75);
    expect_radius(borders.left[2], -1.75);
    expect_radius(borders.right[2], -3.5 - 1.75);
  }
}

TEST(Borders, OfLanesFarApartLeaveAGap) {
  const LaneBorders borders =
      find_borders({straight_lane("left", 4.2), straight_lane("right", 0.0)}, kMaxHalfWidth);
  EXPECT_FALSE(borders.left_is_shared[1]);
  for (const Point2& point : borders.right[0]) EXPECT_NEAR(point.y(), 4.2 - 1.75, 1e-12);
  for (const Point2& point : borders.left[1]) EXPECT_NEAR(point.y(), 1.75, 1e-12);
}

TEST(Borders, OfALaneThatLeavesItsNeighbourLeaveAGapAndNeverOverlap) {
  // 3.2 m apart here, 10 m apart at the end of the window: they are no neighbours on this map.
  const LanePath left = lane("left", arc(Pose2(Point2(-2.0, 3.2), 0.0), 0.002, 100.0, 0.5));
  const LaneBorders borders = find_borders({left, straight_lane("right", 0.0)}, kMaxHalfWidth);
  EXPECT_FALSE(borders.left_is_shared[1]);
  for (const Point2& point : borders.right[0]) {
    EXPECT_GE(point.y(), 1.6 - 2e-3) << "not past the middle, at x = " << point.x();
  }
  for (const Point2& point : borders.left[1]) EXPECT_LE(point.y(), 1.75 + 1e-9);
  for (std::size_t i = 0; i < 20; ++i) EXPECT_LE(borders.left[1][i].y(), borders.right[0][i].y() + 0.01);
}

TEST(Borders, GoOnAtTheLanesOwnWidthWhereTheNeighbourEnds) {
  const LanePath left = straight_lane("left", 3.2), right = straight_lane("right", 0.0, 1, 20.0, 60.0);
  const LaneBorders borders = find_borders({left, right}, kMaxHalfWidth);
  ASSERT_TRUE(borders.left_is_shared[1]);
  for (const Point2& point : borders.right[0]) {
    if (point.x() > 20.0 && point.x() < 60.0) {
      EXPECT_NEAR(point.y(), 1.6, 1e-12);
    } else if (point.x() < 9.0 || point.x() > 71.0) {
      EXPECT_NEAR(point.y(), 3.2 - 1.75, 1e-12) << "beside nothing, at x = " << point.x();
    } else {
      EXPECT_LE(point.y(), 1.6 + 1e-12) << "in between it swings over";
      EXPECT_GE(point.y(), 1.45 - 1e-12);
    }
  }
  EXPECT_NEAR(borders.right[0].front().x(), -2.0, 1e-12);
  EXPECT_NEAR(borders.right[0].back().x(), 100.0, 1e-12);
  EXPECT_NEAR(borders.left[1].front().x(), 20.0, 0.51) << "the short one has its border where it is";
  EXPECT_NEAR(borders.left[1].back().x(), 60.0, 0.51);
}

TEST(Borders, GoOnWhereTheLeftLaneIsTheShorterOne) {
  const LaneBorders borders =
      find_borders({straight_lane("left", 3.2, 1, 20.0, 60.0), straight_lane("right", 0.0)}, kMaxHalfWidth);
  ASSERT_TRUE(borders.left_is_shared[1]);
  for (const Point2& point : borders.left[1]) {
    if (point.x() > 20.0 && point.x() < 60.0) {
      EXPECT_NEAR(point.y(), 1.6, 1e-12);
    } else if (point.x() < 9.0 || point.x() > 71.0) {
      EXPECT_NEAR(point.y(), 1.75, 1e-12);
    }
  }
  for (std::size_t i = 1; i < borders.left[1].size(); ++i) {
    EXPECT_GT(borders.left[1][i].x(), borders.left[1][i - 1].x()) << "without stepping back";
  }
}

TEST(Borders, OfLanesOneAfterTheOtherAreTheirOwn) {
  const LaneBorders borders =
      find_borders({straight_lane("first", 3.0, 0, -2.0, 40.0), straight_lane("then", 0.0, 1, 45.0, 100.0)},
                   kMaxHalfWidth);
  EXPECT_FALSE(borders.left_is_shared[1]);
  for (const Point2& point : borders.right[0]) EXPECT_NEAR(point.y(), 1.25, 1e-12);
  for (const Point2& point : borders.left[1]) EXPECT_NEAR(point.y(), 1.75, 1e-12);
}

TEST(Borders, OfLanesEndToEndKeepTheirWidthWhereTheyMeet) {
  const LaneBorders borders =
      find_borders({straight_lane("first", 0.0, 0, -2.0, 40.0), straight_lane("then", 0.0, 1, 40.0, 100.0)},
                   kMaxHalfWidth);
  for (const Point2& point : borders.right[0]) EXPECT_NEAR(point.y(), -1.75, 1e-12);
  for (const Point2& point : borders.left[1]) EXPECT_NEAR(point.y(), 1.75, 1e-12);
}

TEST(Borders, DoNotFoldOnTheInsideOfATightCurve) {
  // A radius of 2 m, and a half width of 1.75 m would be fine; at 1.5 m radius the border would run
  // backwards.
  const LanePath tight = lane("a", arc(Pose2(Point2(-1.0, 0.0), 0.0), 1.0 / 1.5, 4.0, 0.1));
  const LaneBorders borders = find_borders({tight}, kMaxHalfWidth);
  for (std::size_t i = 1; i < borders.left[0].size(); ++i) {
    EXPECT_GT((borders.left[0][i] - borders.left[0][i - 1]).dot(tight.points[i].direction), 0.0);
  }
}

TEST(Borders, OfLanesThatChangeSidesAreNotShared) {
  // Round a U-turn of coarse vertices, the one that was left is right.
  const Polyline uturn = {{-2.0, 0.0}, {20.0, 0.0}, {22.0, 2.0}, {22.0, 18.0}, {20.0, 20.0}, {-2.0, 20.0}};
  Polyline beside = uturn;
  for (Point2& point : beside) point += Point2(0.0, -3.5);
  EXPECT_FALSE(find_borders({lane("left", uturn), lane("right", beside)}, kMaxHalfWidth).left_is_shared[1]);
}

TEST(Borders, ThatAreSharedLeaveEachLaneItsShareWhateverPaintSays) {
  LanePath left = straight_lane("left", 3.5);
  left.seen = SeenHalfWidths{{}, 3.3, 100.0};
  const LaneBorders borders = find_borders({left, straight_lane("right", 0.0)}, kMaxHalfWidth);
  ASSERT_TRUE(borders.left_is_shared[1]);
  EXPECT_NEAR(borders.right[0][20].y(), 3.5 * 0.3, 1e-9);
}

}  // namespace
}  // namespace relative_map::core
