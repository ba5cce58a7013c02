#include "relative_map/route/relative_map_route.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "relative_map/route/route_check.hpp"

namespace relative_map::core {
namespace {

/// Lanes left to right, 3.5 m apart; the vehicle is in the one number `own`. Priorities as given.
RelativeMap map_of(const std::vector<std::uint32_t>& priorities, int own) {
  RelativeMap map;
  for (std::size_t i = 0; i < priorities.size(); ++i) {
    Lane lane;
    lane.id = "lane_" + std::to_string(i);
    lane.priority = priorities[i];
    lane.remaining_distance = 1000.0;
    for (double x = -30.0; x <= 210.0; x += 10.0) {
      PathPoint point;
      point.position = {x, 3.5 * (own - static_cast<int>(i))};
      lane.path.push_back(point);
    }
    if (i > 0) {
      lane.left_neighbor_id = map.lanes.back().id;
      map.lanes.back().right_neighbor_id = lane.id;
    }
    map.lanes.push_back(lane);
  }
  map.current_lane_id = "lane_" + std::to_string(own);
  return map;
}

const RouteSegments& of(const RelativeMapRoute& route, const std::string& id) {
  for (const RouteSegments& segments : route.update.segments) {
    if (segments.id == id) return segments;
  }
  throw std::runtime_error("no segments " + id);
}

void expect_contract(const RelativeMapRoute& route) {
  for (const RouteViolation& violation : check_route(route.update, nullptr)) {
    ADD_FAILURE() << violation.row << ": " << violation.what;
  }
}

TEST(RelativeMapRoute, OnTheBestLaneItIsFollowed) {
  const RelativeMapRoute route = route_on_relative_map(map_of({1, 0, 2}, 1));
  expect_contract(route);
  EXPECT_EQ(route.target_lane, "lane_1");
  const RouteSegments& own = route.update.segments.front();
  EXPECT_TRUE(own.is_on_segment);
  EXPECT_TRUE(own.can_exit);
  EXPECT_EQ(own.next_action, ChangeLane::kForward);
  EXPECT_FALSE(of(route, "lane_0").is_neighbor);
  EXPECT_EQ(of(route, "lane_0").next_action, ChangeLane::kRight);
  EXPECT_EQ(of(route, "lane_0").previous_action, ChangeLane::kLeft);
  EXPECT_EQ(own.segments.front().end_s, 240.0);
}

TEST(RelativeMapRoute, TwoLanesFromTheBestTheNextOneIsBetween) {
  const RelativeMapRoute route = route_on_relative_map(map_of({4, 3, 2, 1, 0}, 2));
  expect_contract(route);
  EXPECT_EQ(route.current_lane, "lane_2");
  EXPECT_EQ(route.target_lane, "lane_4");
  EXPECT_EQ(of(route, "lane_2").next_action, ChangeLane::kRight);
  EXPECT_FALSE(of(route, "lane_2").can_exit);
  EXPECT_TRUE(of(route, "lane_3").is_neighbor);
  EXPECT_EQ(of(route, "lane_3").previous_action, ChangeLane::kRight);
  EXPECT_FALSE(of(route, "lane_4").is_neighbor);
  EXPECT_TRUE(of(route, "lane_4").can_exit);
  EXPECT_EQ(of(route, "lane_4").priority, 2u);
}

TEST(RelativeMapRoute, ALaneThatNoChangeLeadsToIsNoTarget) {
  RelativeMap map = map_of({0, 1, 2}, 2);
  map.lanes[0].right_neighbor_id.clear();
  map.lanes[1].left_neighbor_id.clear();
  const RelativeMapRoute route = route_on_relative_map(map);
  expect_contract(route);
  EXPECT_EQ(route.target_lane, "lane_1");
  EXPECT_EQ(route.update.segments.back().id, "lane_0");
  EXPECT_EQ(route.update.segments.back().previous_action, ChangeLane::kLeft);
}

TEST(RelativeMapRoute, WithoutACurrentLaneTheNearestIsOwn) {
  RelativeMap map = map_of({1, 0}, 1);
  map.current_lane_id.clear();
  EXPECT_EQ(route_on_relative_map(map).current_lane, "lane_1");
  for (Lane& lane : map.lanes) {
    for (PathPoint& point : lane.path) point.position.y() += 30.0;
  }
  EXPECT_EQ(route_on_relative_map(map).update.status.code, RouteCode::kOffRoute);
}

TEST(RelativeMapRoute, WhereTheLineEndsIsTheDestination) {
  RelativeMap map = map_of({0}, 0);
  EXPECT_FALSE(route_on_relative_map(map).update.segments[0].stop_for_destination);
  map.lanes[0].remaining_distance = 210.0;
  const RelativeMapRoute route = route_on_relative_map(map);
  EXPECT_TRUE(route.update.segments[0].stop_for_destination);
  ASSERT_TRUE(route.update.segments[0].route_end);
  EXPECT_EQ(route.update.segments[0].route_end->s, 240.0);
  EXPECT_EQ(route.update.place->distance_to_destination, 210.0);
}

TEST(RelativeMapRoute, AnEmptyMapIsRefusedWithItsOwnReason) {
  RelativeMap map;
  map.status = {StatusCode::kOffRoute, "no line is near"};
  const RelativeMapRoute route = route_on_relative_map(map);
  EXPECT_EQ(route.update.status.code, RouteCode::kNoMap);
  EXPECT_THAT(route.update.status.message, testing::HasSubstr("no line is near"));
  map = map_of({0}, 0);
  map.lanes[0].path[3].position.x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(route_on_relative_map(map).update.status.code, RouteCode::kNoMap);
}

}  // namespace
}  // namespace relative_map::core
