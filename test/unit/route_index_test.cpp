#include "relative_map/route/route_index.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using test::passage;
using testing::HasSubstr;

const double kNan = std::numeric_limits<double>::quiet_NaN();

Route keep() {
  return test::one_passage_roads({{"a0", 10.0, 100.0}, {"a1", 0.0, 100.0}, {"a2", 0.0, 90.0}});
}

RouteIndex::Result built(const Route& route, const LaneGraph& graph = test::grid(2, 4)) {
  return RouteIndex::build(test::prepared(graph), route);
}

void expect_refused(const Route& route, RouteCode code, const std::string& why) {
  const RouteIndex::Result result = built(route);
  EXPECT_EQ(result.index, nullptr);
  EXPECT_EQ(result.status.code, code);
  EXPECT_THAT(result.status.message, HasSubstr(why));
}

TEST(RouteIndex, ARouteThatIsRightIsTakenAsItIs) {
  const RouteIndex::Result result = built(keep());
  ASSERT_NE(result.index, nullptr) << result.status.message;
  EXPECT_TRUE(result.repairs.empty());
  ASSERT_EQ(result.index->pieces().size(), 3u);
  EXPECT_EQ(result.index->next(0), 1u);
  EXPECT_EQ(result.index->previous(2), 1u);
  EXPECT_FALSE(result.index->next(2));
  EXPECT_NEAR(result.index->distance_to_destination({0, 40.0}), 60.0 + 100.0 + 90.0, 1e-9);
}

TEST(RouteIndex, BadRoutesAreRefusedByName) {
  Route route = keep();
  route.roads.clear();
  expect_refused(route, RouteCode::kBadRoute, "no road");
  route = keep();
  route.roads[1].passages.clear();
  expect_refused(route, RouteCode::kBadRoute, "road 1 of the route has no passage");
  route = keep();
  route.roads[1].passages[0].segments.clear();
  expect_refused(route, RouteCode::kBadRoute, "passage 0 of road 1 has no segment");
  route = keep();
  route.roads[1].passages[0].segments[0].lane_id = "gone";
  expect_refused(route, RouteCode::kUnknownLane, "'gone'");
  route = keep();
  route.roads[1].passages[0].segments[0].end_s = 140.0;
  expect_refused(route, RouteCode::kBadRoute, "140] m of lane 'a1', which is 100 m long");
  route = keep();
  route.roads[1].passages[0].segments[0].start_s = kNan;
  expect_refused(route, RouteCode::kBadRoute, "'a1' has an s that is not finite");
  route = keep();
  route.roads[1].passages[0].segments[0].start_s = 120.0;
  route.roads[1].passages[0].segments[0].end_s = 80.0;
  expect_refused(route, RouteCode::kBadRoute, "runs backwards");
  route = keep();
  route.waypoints.pop_back();
  expect_refused(route, RouteCode::kBadWaypoint, "1 waypoints");
}

TEST(RouteIndex, LanesThatDoNotFollowEachOtherAreNoPassage) {
  Route route = keep();
  route.roads = {{"", {passage({{"a0", 10.0, 100.0}, {"a2", 0.0, 90.0}})}}};
  expect_refused(route, RouteCode::kBadRoute, "lane 'a2' does not follow lane 'a0'");
}

// The original loses all waypoints after it, or runs past its list.
TEST(RouteIndex, AWaypointThatLiesNowhereIsNamed) {
  Route route = keep();
  route.waypoints.insert(route.waypoints.begin() + 1, {"b1", 50.0, {}});
  expect_refused(route, RouteCode::kBadWaypoint, "waypoint 1, lane 'b1' at 50 m, lies nowhere");
  route = keep();
  route.waypoints.back() = {"a2", 99.0, {}};
  expect_refused(route, RouteCode::kBadWaypoint, "waypoint 1, lane 'a2' at 99 m, lies nowhere");
  route = keep();
  route.waypoints.front().s = kNan;
  expect_refused(route, RouteCode::kBadWaypoint, "waypoint 0");
  route = keep();
  route.waypoints = {{"a1", 5.0, {}}, {"a0", 50.0, {}}, {"a2", 90.0, {}}};
  expect_refused(route, RouteCode::kBadWaypoint, "waypoint 1, lane 'a0'");
}

TEST(RouteIndex, AnotherFrameIsRefused) {
  LaneGraph graph = test::grid(2, 4);
  graph.frame_id = "map";
  Route route = keep();
  route.frame_id = "utm_33";
  EXPECT_EQ(built(route, graph).status.code, RouteCode::kFrameMismatch);
  route.frame_id = "map";
  EXPECT_NE(built(route, graph).index, nullptr);
}

// In three recorded routes a segment ends inside of its lane, and the next one starts on the lane after it.
TEST(RouteIndex, HolesAreClosedAndTold) {
  Route route;
  route.roads = {{"", {passage({{"a0", 10.0, 40.0}, {"a1", 7.0, 100.0}, {"a2", 0.0, 90.0}})}}};
  route.waypoints = {{"a0", 10.0, {}}, {"a2", 90.0, {}}};
  const RouteIndex::Result result = built(route);
  ASSERT_NE(result.index, nullptr) << result.status.message;
  EXPECT_EQ(result.index->pieces()[0].end, 100.0);
  EXPECT_EQ(result.index->pieces()[1].start, 0.0);
  ASSERT_EQ(result.repairs.size(), 1u);
  EXPECT_THAT(result.repairs[0], HasSubstr("a hole of 67 m between lane 'a0' and lane 'a1'"));
  EXPECT_NEAR(result.index->distance_to_destination({0, 10.0}), 280.0, 1e-9);
}

TEST(RouteIndex, APieceWithoutLengthIsLeftOutAndItsWaypointIsTheEndBeforeIt) {
  Route route;
  route.roads = {{"", {passage({{"a0", 10.0, 100.0}})}},
                 {"", {passage({{"a1", 0.0, 100.0}, {"a2", 0.0, 0.0}})}}};
  route.waypoints = {{"a0", 10.0, {}}, {"a2", 0.0, {}}};
  RouteIndex::Result result = built(route);
  ASSERT_NE(result.index, nullptr) << result.status.message;
  EXPECT_EQ(result.index->pieces().size(), 2u);
  EXPECT_EQ(result.index->destination().piece, 1u);
  EXPECT_EQ(result.index->destination().s, 100.0);
  EXPECT_THAT(result.repairs.at(0), HasSubstr("lane 'a2' has no length"));

  // As a road of its own, side by side with another such one, as in a recorded route.
  route.roads = {{"", {passage({{"a0", 10.0, 100.0}})}},
                 {"", {passage({{"a1", 0.0, 100.0}})}},
                 {"", {passage({{"a2", 0.0, 0.0}}), passage({{"b2", 0.0, 1e-7}})}}};
  result = built(route);
  ASSERT_NE(result.index, nullptr) << result.status.message;
  EXPECT_EQ(result.index->passages().size(), 2u);
  EXPECT_EQ(result.index->destination().s, 100.0);
}

TEST(RouteIndex, OnALapTheDestinationIsTheLastPassOfItsPlace) {
  const double quarter = test::prepared(test::ring(4, 50.0))->lane(0).length();
  const Route route = test::one_passage_roads({{"q0", 10.0, quarter},
                                               {"q1", 0.0, quarter},
                                               {"q2", 0.0, quarter},
                                               {"q3", 0.0, quarter},
                                               {"q0", 0.0, 10.0}});
  const auto index = built(route, test::ring(4, 50.0)).index;
  ASSERT_NE(index, nullptr);
  EXPECT_EQ(index->waypoints()[0].piece, 0u);
  EXPECT_EQ(index->destination().piece, 4u);
  EXPECT_TRUE(index->destination_comes_twice());
  EXPECT_NEAR(index->distance_to_destination({0, 10.0}), 4.0 * quarter, 1e-9);
}

TEST(RouteIndex, TheNextWaypointIsAMatterOfThePlaceAlone) {
  Route route = keep();
  route.waypoints.insert(route.waypoints.begin() + 1, {"a1", 50.0, {}});
  const auto index = built(route).index;
  ASSERT_NE(index, nullptr);
  EXPECT_EQ(index->next_waypoint({0, 5.0}), 0u);
  EXPECT_EQ(index->next_waypoint({0, 10.0}), 1u);
  EXPECT_EQ(index->next_waypoint({1, 49.9}), 1u);
  EXPECT_EQ(index->next_waypoint({1, 50.0}), 2u);
  EXPECT_EQ(index->next_waypoint({2, 90.0}), 2u);
}

TEST(RouteIndex, DistancesCountLaneChangesAsNothing) {
  Route route;
  route.roads = {{"",
                  {passage({{"b0", 10.0, 100.0}, {"b1", 0.0, 100.0}}, ChangeLane::kLeft, false),
                   passage({{"a0", 0.0, 100.0}, {"a1", 0.0, 100.0}})}},
                 {"", {passage({{"a2", 0.0, 80.0}})}}};
  route.waypoints = {{"b0", 10.0, {}}, {"a2", 80.0, {}}};
  const auto index = built(route).index;
  ASSERT_NE(index, nullptr);
  EXPECT_NEAR(index->distance_to_destination({0, 30.0}), 70.0 + 100.0 + 80.0, 1e-9);
  EXPECT_NEAR(index->distance_to_destination({2, 30.0}), 70.0 + 100.0 + 80.0, 1e-9);
}

TEST(SameWay, ANewNameIsNoNewRoute) {
  Route a = keep(), b = keep();
  b.id = "another";
  EXPECT_TRUE(same_way(a, b));
  b.roads[2].passages[0].segments[0].end_s = 89.0;
  EXPECT_FALSE(same_way(a, b));
}

}  // namespace
}  // namespace relative_map::core
