#include "relative_map/prediction/lane_view.hpp"

#include <gmock/gmock.h>

#include "relative_map/prediction/lane_sequence.hpp"
#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

std::vector<LanePlace> places(const LaneView& view, const Point2& point, double radius = 5.0) {
  std::vector<LanePlace> result;
  view.places(point, radius, result);
  return result;
}

TEST(LaneView, EveryLaneHasItsOwnOffset) {
  const LaneView view(two_lanes());
  const auto found = places(view, {50.0, 1.0});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_NEAR(found[0].l, 1.0, 1e-9);
  EXPECT_NEAR(found[1].l, -2.5, 1e-9);
  EXPECT_NEAR(found[0].s, 50.0, 1e-9);
}

TEST(LaneView, OffsetIsLateralOnACircle) {
  TrafficLanes lanes;
  lanes.lanes = {curved_lane("c", 0.0, 0.0, 0.0, 50.0, 100.0)};
  const LaneView view(lanes);
  for (const double s : {3.3, 40.2, 80.7}) {
    for (const double l : {-3.0, -0.5, 0.0, 2.0}) {
      const double angle = s / 50.0;
      const Point2 point((50.0 - l) * std::sin(angle), 50.0 - (50.0 - l) * std::cos(angle));
      const auto found = places(view, point);
      ASSERT_EQ(found.size(), 1u);
      EXPECT_NEAR(found[0].l, l, 0.01);
      EXPECT_NEAR(found[0].s, s, 0.05);
      EXPECT_NEAR(found[0].theta, angle, 0.01);
    }
  }
  EXPECT_NEAR(view.lanes()[0].at(50.0).kappa, 1.0 / 50.0, 1e-3);
}

TEST(LaneView, FarLanesAreNotFoundHoweverTheyBend) {
  TrafficLanes lanes;
  lanes.lanes = {curved_lane("c", 0.0, 0.0, 0.0, 30.0, 90.0), straight_lane("s", -2.0)};
  const LaneView view(lanes);
  EXPECT_EQ(places(view, {0.0, 30.0}).size(), 0u);
  EXPECT_EQ(places(view, {0.0, 59.0}).size(), 1u);
}

TEST(LaneView, ALaneThatEndsGoesStraightOn) {
  const LaneView view(two_lanes());
  const auto found = places(view, {220.0, 1.0}, 2.0);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(found[0].s, 220.0, 1e-9);
  EXPECT_NEAR(found[0].l, 1.0, 1e-9);
  EXPECT_NEAR(view.lanes()[0].at(230.0).position.x(), 230.0, 1e-9);
  EXPECT_EQ(places(view, {300.0, 0.0}).size(), 0u);
}

TEST(LaneView, BadLanesAreLeftOut) {
  TrafficLanes lanes = two_lanes();
  TrafficLane point, twice = straight_lane("left", 9.0), broken = straight_lane("broken", 20.0);
  point.id = "point";
  point.center = {{0.0, 0.0}, {0.0, 0.0}};
  broken.center[3].x() = kNotGiven;
  lanes.lanes.push_back(point);
  lanes.lanes.push_back(twice);
  lanes.lanes.push_back(broken);
  lanes.lanes[0].successors = {"right", "nowhere"};
  const LaneView view(lanes);
  EXPECT_EQ(view.lanes().size(), 3u);
  EXPECT_TRUE(view.lanes()[0].successors.empty());
}

TEST(LaneSequence, EveryBranchWithinReachIsAWay) {
  TrafficLanes lanes;
  lanes.lanes = {straight_lane("in", 0.0, 0.0, 30.0), straight_lane("on", 0.0, 30.0, 200.0),
                 curved_lane("turn", 30.0, 0.0, 0.0, 15.0, 23.0)};
  lanes.lanes[0].successors = {"turn", "on"};
  const LaneView view(lanes);
  std::vector<LaneSequence> ways;
  sequences_from(view, {0, 5.0, 0.0, 0.0}, 40.0, 100.0, 6, ways);
  ASSERT_EQ(ways.size(), 2u);
  EXPECT_NEAR(ways[0].turn(5.0, 60.0) + ways[1].turn(5.0, 60.0), 23.0 / 15.0, 0.1);
  ways.clear();
  sequences_from(view, {0, 5.0, 0.0, 0.0}, 10.0, 100.0, 6, ways);
  ASSERT_EQ(ways.size(), 1u);  // the straight one
  EXPECT_NEAR(ways[0].at(100.0).position.x(), 100.0, 1e-6);
}

TEST(LaneSequence, ACircleOfLanesEnds) {
  TrafficLanes lanes;
  lanes.lanes = {straight_lane("a", 0.0, 0.0, 5.0), straight_lane("b", 0.0, 5.0, 10.0)};
  lanes.lanes[0].successors = {"b"};
  lanes.lanes[1].successors = {"a"};
  const LaneView view(lanes);
  std::vector<LaneSequence> ways;
  sequences_from(view, {0, 1.0, 0.0, 0.0}, 1e5, 1e5, 6, ways);
  ASSERT_EQ(ways.size(), 1u);
  EXPECT_LE(ways[0].lanes().size(), 40u);
}

}  // namespace
}  // namespace relative_map::core::test
