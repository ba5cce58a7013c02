#include "relative_map/route/lane_projection.hpp"

#include <gtest/gtest.h>

#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

TEST(LaneProjection, GoesOnPastBothEndsOfALane) {
  const LaneLine lane(test::straight({0.0, 0.0}, {60.0, 0.0}));
  EXPECT_NEAR(lane.project({20.0, 1.5}).s, 20.0, 1e-12);
  EXPECT_NEAR(lane.project({20.0, 1.5}).l, 1.5, 1e-12);
  EXPECT_NEAR(lane.project({-4.0, -1.0}).s, -4.0, 1e-12);
  EXPECT_NEAR(lane.project({-4.0, -1.0}).l, -1.0, 1e-12);
  EXPECT_NEAR(lane.project({63.0, 2.0}).s, 63.0, 1e-12);
  EXPECT_NEAR(lane.project({63.0, 2.0}).l, 2.0, 1e-12);
  EXPECT_NEAR(lane.project({63.0, 4.0}).distance, 5.0, 1e-12);
}

// The original clamps s on such lanes, and so does not see that a vehicle has driven past them.
TEST(LaneProjection, GoesOnPastBothEndsOfALaneOfOneChord) {
  const LaneLine lane(Polyline{{0.0, 0.0}, {60.0, 0.0}});
  EXPECT_NEAR(lane.project({-4.0, 0.5}).s, -4.0, 1e-12);
  EXPECT_NEAR(lane.project({100.0, -20.0}).s, 100.0, 1e-12);
  EXPECT_NEAR(lane.project({100.0, -20.0}).l, -20.0, 1e-12);
}

TEST(LaneProjection, AtAKinkTheOffsetIsTheDistanceToTheVertex) {
  const LaneLine lane(Polyline{{0.0, 0.0}, {10.0, 0.0}, {10.0, -10.0}});
  const LaneProjection outside = lane.project({13.0, 4.0});
  EXPECT_NEAR(outside.s, 10.0, 1e-12);
  EXPECT_NEAR(outside.l, 5.0, 1e-12);
  EXPECT_NEAR(outside.distance, 5.0, 1e-12);
}

TEST(LaneProjection, TheHeadingIsThatOfTheChord) {
  const LaneLine lane(Polyline{{0.0, 0.0}, {10.0, 0.0}, {10.0, -10.0}});
  EXPECT_EQ(lane.heading_at(-3.0), 0.0);
  EXPECT_EQ(lane.heading_at(9.9), 0.0);
  EXPECT_NEAR(lane.heading_at(10.1), -kPi / 2.0, 1e-12);
  // Past the end, by however little: the original reads behind its array there.
  EXPECT_NEAR(lane.heading_at(20.0005), -kPi / 2.0, 1e-12);
}

TEST(LaneProjection, DoublePointsAreOnePoint) {
  const LaneLine lane(Polyline{{0.0, 0.0}, {0.0, 0.0}, {10.0, 0.0}, {10.0, 0.0}});
  EXPECT_EQ(lane.points().size(), 2u);
  EXPECT_NEAR(lane.length(), 10.0, 1e-12);
}

TEST(LaneProjection, TellsEveryPassOfALaneThatCrossesItself) {
  const LaneLine lane(Polyline{{-20.0, 0.0}, {20.0, 0.0}, {20.0, 20.0}, {0.0, 20.0}, {0.0, -20.0}});
  const auto passes = lane.passes({1.0, 2.0}, 10.0);
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_NEAR(passes[0].s, 21.0, 1e-12);
  EXPECT_NEAR(passes[1].s, 40.0 + 20.0 + 20.0 + 18.0, 1e-12);
  EXPECT_NEAR(passes[1].l, 1.0, 1e-12);
}

TEST(LaneProjection, HoldsPointsAtTheEnds) {
  const LaneLine lane(test::straight({0.0, 0.0}, {60.0, 0.0}));
  EXPECT_EQ(lane.point_at(-5.0), Point2(0.0, 0.0));
  EXPECT_EQ(lane.point_at(70.0), Point2(60.0, 0.0));
  EXPECT_NEAR(lane.point_at(12.3).x(), 12.3, 1e-12);
}

}  // namespace
}  // namespace relative_map::core
