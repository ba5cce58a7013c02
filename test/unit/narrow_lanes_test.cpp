#include "relative_map/pipeline/lanes/narrow_lanes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relative_map/pipeline/lanes/lane_width.hpp"
#include "support/lanes.hpp"

namespace relative_map::core {
namespace {

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

/// The vehicle is in the lane `kept`; without one, in the best.
std::vector<std::string> drop_narrow_lanes(std::vector<LanePath>& lanes, double half_width,
                                           const std::string& kept = "") {
  std::size_t current = 0;
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    const bool better = lanes[i].priority < lanes[current].priority;
    if (kept.empty() ? better : lanes[i].id == kept) current = i;
  }
  const std::string id = lanes[current].id;
  const std::vector<std::string> sentences = make_room(lanes, current, half_width);
  EXPECT_EQ(lanes.at(current).id, id);
  return sentences;
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

}  // namespace
}  // namespace relative_map::core
