#include "relative_map/pipeline/lane_width.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/lanes.hpp"

#include "relative_map/pipeline/narrow_lanes.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::concentric_lane;
using test::distance_by_brute_force;
using test::lane;
using test::straight;
using test::straight_lane;
using testing::HasSubstr;

constexpr double kMaxHalfWidth = 2.0;  // [m] neighbours are up to 4 m apart
constexpr double kHalfWidth = 0.95;    // [m] of the vehicle

std::vector<std::string> ids_of(const std::vector<LanePath>& lanes) {
  std::vector<std::string> ids;
  for (const LanePath& lane : lanes) ids.push_back(lane.id);
  return ids;
}

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

TEST(NarrowLanes, AreKeptWhereTheVehicleFits) {
  std::vector<LanePath> lanes = {straight_lane("left", 2.0), straight_lane("right", 0.0, 1)};
  EXPECT_TRUE(drop_narrow_lanes(lanes, kHalfWidth).empty());
  EXPECT_EQ(lanes.size(), 2u);
}

TEST(NarrowLanes, LoseTheOneOfWorsePriority) {
  for (const bool left_is_better : {true, false}) {
    std::vector<LanePath> lanes = {straight_lane("left", 1.8, left_is_better ? 0 : 1),
                                   straight_lane("right", 0.0, left_is_better ? 1 : 0)};
    const std::vector<std::string> sentences = drop_narrow_lanes(lanes, kHalfWidth);
    ASSERT_EQ(sentences.size(), 1u);
    EXPECT_THAT(sentences[0], HasSubstr(left_is_better ? "'right' is left out" : "'left' is left out"));
    ASSERT_EQ(lanes.size(), 1u);
    EXPECT_EQ(lanes[0].id, left_is_better ? "left" : "right");
  }
}

TEST(NarrowLanes, OfTheSameLineAreFoundWhereverItsVerticesAre) {
  for (int i = 1; i < 200; ++i) {
    const Pose2 start(Point2(-0.98 - 0.01 * i, -4.5 + 0.02 * i), 0.02 * i);
    const Polyline points = straight(start, 4.5, 0.4707);
    std::vector<LanePath> lanes = {lane("a", points, 0), lane("b", points, 1)};
    drop_narrow_lanes(lanes, kHalfWidth);
    EXPECT_EQ(lanes.size(), 1u);
  }
}

TEST(NarrowLanes, LeaveOneOfThreeThatAreTheSame) {
  std::vector<LanePath> lanes = {straight_lane("a", 0.0, 2), straight_lane("b", 0.0, 0),
                                 straight_lane("c", 0.0, 1)};
  EXPECT_EQ(drop_narrow_lanes(lanes, kHalfWidth).size(), 2u);
  EXPECT_EQ(ids_of(lanes), std::vector<std::string>({"b"}));
}

TEST(NarrowLanes, MakeRoomForThoseThatBecomeNeighbours) {
  // Without the middle one the outer two fit.
  std::vector<LanePath> lanes = {straight_lane("left", 2.4, 0), straight_lane("middle", 1.2, 2),
                                 straight_lane("right", 0.0, 1)};
  drop_narrow_lanes(lanes, kHalfWidth);
  EXPECT_EQ(ids_of(lanes), std::vector<std::string>({"left", "right"}));
}

/// From 3.5 m to the left of the x axis onto it, between x = `from` and `from` + 40.
Polyline merging(double from, double spacing) {
  Polyline points;
  for (double x = -2.0; x <= 150.0; x += spacing) {
    const double t = std::clamp((x - from) / 40.0, 0.0, 1.0);
    points.emplace_back(x, 3.5 * (1.0 - t * t * (3.0 - 2.0 * t)));
  }
  return points;
}

TEST(NarrowLanes, EndWhereTheyMergeAhead) {
  std::vector<LanePath> lanes = {lane("left", merging(50.0, 0.5), 1),
                                 straight_lane("right", 0.0, 0, -2.0, 150.0)};
  const std::vector<std::string> sentences = drop_narrow_lanes(lanes, kHalfWidth);
  ASSERT_EQ(sentences.size(), 1u);
  EXPECT_THAT(sentences[0], HasSubstr("'left' is cut short: 69"));
  ASSERT_EQ(lanes.size(), 2u);
  EXPECT_GT(lanes[0].points.back().position.y(), 1.8);
  EXPECT_LT(lanes[0].points.back().position.y(), 2.2) << "right where it becomes too narrow";
  EXPECT_NEAR(lanes[0].remaining, lanes[0].points.back().s - lanes[0].s_at_vehicle, 1e-12);
  const LaneBorders borders = find_borders(lanes, kMaxHalfWidth);
  EXPECT_TRUE(borders.left_is_shared[1]);
}

TEST(NarrowLanes, AreLeftOutWhereTheyMergeRightAhead) {
  std::vector<LanePath> lanes = {lane("left", merging(5.0, 0.5), 1),
                                 straight_lane("right", 0.0, 0, -2.0, 150.0)};
  EXPECT_THAT(drop_narrow_lanes(lanes, kHalfWidth).at(0), HasSubstr("'left' is left out"));
  EXPECT_EQ(lanes.size(), 1u);
}

TEST(NarrowLanes, AppearWhereTheForkIsBehind) {
  // Two ways from one: while it is ahead there is one lane, the better one.
  Polyline off;
  for (double x = -2.0; x <= 150.0; x += 0.5)
    off.emplace_back(x, x < 10.0 ? 0.0 : 0.005 * (x - 10.0) * (x - 10.0));
  std::vector<LanePath> lanes = {lane("off", off, 1), straight_lane("on", 0.0, 0, -2.0, 150.0)};
  drop_narrow_lanes(lanes, kHalfWidth);
  EXPECT_EQ(ids_of(lanes), std::vector<std::string>({"on"}));
}

TEST(NarrowLanes, OfSparseVerticesNeverLoseTheirLastSegment) {
  // The first vertex of this line that is too near is its second one, 60 m ahead.
  for (const double spacing : {20.0, 31.0, 60.0, 76.0}) {
    std::vector<LanePath> lanes = {lane("left", merging(20.0, spacing), 1),
                                   straight_lane("right", 0.0, 0, -2.0, 150.0)};
    drop_narrow_lanes(lanes, kHalfWidth);
    for (const LanePath& kept : lanes) {
      EXPECT_GE(kept.points.size(), 2u) << spacing << " m from vertex to vertex";
      EXPECT_GT(kept.points.back().s, kept.s_at_vehicle) << "it does not end behind the vehicle";
    }
  }
}

TEST(NarrowLanes, AreFoundBetweenSparseVertices) {
  // They cross in the middle between two vertices, 30 m from either.
  std::vector<LanePath> lanes = {
      lane("left", {Point2(-2.0, 3.0), Point2(58.0, 3.0), Point2(118.0, -3.0)}, 1),
      lane("right", {Point2(-2.0, 0.0), Point2(58.0, 0.0), Point2(118.0, 0.0)}, 0)};
  drop_narrow_lanes(lanes, kHalfWidth);
  for (const LanePath& kept : lanes) {
    if (kept.id == "left") {
      EXPECT_LE(kept.points.back().position.x(), 58.0);
    }
  }
}

TEST(NarrowLanes, AreFoundWhereTheyOverlapOnAShortStretch) {
  // The one ends 0.2 m past the start of the other; a narrow vehicle would be let between them.
  std::vector<LanePath> lanes = {straight_lane("ahead", 0.0, 1, 10.0, 60.0),
                                 straight_lane("here", 0.0, 0, -2.0, 10.2, 0.2)};
  EXPECT_EQ(drop_narrow_lanes(lanes, 0.08).size(), 1u);
  EXPECT_EQ(ids_of(lanes), std::vector<std::string>({"here"}));
}

TEST(Borders, OfLanesThatChangeSidesAreNotShared) {
  // Round a U-turn of coarse vertices, the one that was left is right.
  const Polyline uturn = {{-2.0, 0.0}, {20.0, 0.0}, {22.0, 2.0}, {22.0, 18.0}, {20.0, 20.0}, {-2.0, 20.0}};
  Polyline beside = uturn;
  for (Point2& point : beside) point += Point2(0.0, -3.5);
  EXPECT_FALSE(find_borders({lane("left", uturn), lane("right", beside)}, kMaxHalfWidth).left_is_shared[1]);
}

TEST(NarrowLanes, KeepTheOneThatIsToBeKeptOnEitherSide) {
  for (const char* kept : {"left", "right"}) {
    for (const std::uint32_t left_priority : {0u, 2u}) {
      std::vector<LanePath> lanes = {straight_lane("left", 1.0, left_priority),
                                     straight_lane("right", 0.0, 1)};
      drop_narrow_lanes(lanes, kHalfWidth, kept);
      EXPECT_EQ(ids_of(lanes), std::vector<std::string>{kept}) << left_priority;
    }
  }
}

TEST(NarrowLanes, AreNotThoseThatFollowOneAnother) {
  std::vector<LanePath> lanes = {straight_lane("here", 0.0, 0, -2.0, 60.0),
                                 straight_lane("there", 0.5, 1, 61.0, 150.0)};
  EXPECT_TRUE(drop_narrow_lanes(lanes, kHalfWidth).empty());
  EXPECT_EQ(lanes.size(), 2u);
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
