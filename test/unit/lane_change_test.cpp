// Lane changes that are asked for: why they are refused, the way that they make, and how they end.
#include "relative_map/route/lane_change.hpp"

#include <gmock/gmock.h>

#include "relative_map/route/lane_change_plan.hpp"
#include "relative_map/route/route_check.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

LaneChangeRequest to_left() {
  return {LaneChangeGoal::kLeft, "", false};
}

LaneChangeRequest to_lane(const std::string& id, bool force = false) {
  return {LaneChangeGoal::kLane, id, force};
}

/// Three rows a, b, c of 100 m pieces; the route leads along b.
class LaneChangeTest : public testing::Test {
 protected:
  void make(const LaneGraph& graph) {
    network_ = test::prepared(graph);
    search_.emplace(network_, SearchParam{});
    map_ = RouteMap(RouteParam{});
    map_.set_graph(network_);
    const RouteStatus status = map_.set_route(test::one_passage_roads(
        {{"b0", 10.0, 100.0}, {"b1", 0.0, 100.0}, {"b2", 0.0, 100.0}, {"b3", 0.0, 90.0}}));
    ASSERT_EQ(status.code, RouteCode::kOk) << status.message;
  }
  void SetUp() override { make(test::grid(3, 4)); }

  RouteUpdate at(double x, double y) {
    RouteUpdate update = map_.update(Pose2({x, y}, 0.0), 10.0);
    for (const RouteViolation& row : check_route(update, map_.index()))
      ADD_FAILURE() << row.row << ": " << row.what;
    return update;
  }
  LaneChangePlan plan(double x, const LaneChangeRequest& request, double speed = 10.0) {
    return plan_lane_change(map_, *search_, *at(x, -3.5).place, speed, param_, request);
  }

  LaneChangeParam param_;
  std::shared_ptr<const LaneNetwork> network_;
  std::optional<RouteSearch> search_;
  RouteMap map_{RouteParam{}};
};

TEST_F(LaneChangeTest, LeadsOverTheLaneBesideAndOnToTheDestination) {
  const LaneChangePlan found = plan(50.0, to_left());
  ASSERT_EQ(found.why_not, "");
  EXPECT_EQ(found.side, ChangeLane::kLeft);
  EXPECT_EQ(found.from.front(), "b0");
  EXPECT_EQ(found.to.front(), "a0");
  ASSERT_EQ(map_.set_route(found.route).code, RouteCode::kOk);
  RouteUpdate update = at(50.0, -3.5);
  ASSERT_EQ(update.segments.size(), 2u);
  EXPECT_EQ(update.place->lane_id, "b0");
  EXPECT_EQ(update.segments[0].next_action, ChangeLane::kLeft);
  EXPECT_EQ(update.segments[1].previous_action, ChangeLane::kLeft);
  EXPECT_EQ(update.segments[1].segments.back().lane_id, "a2");
  // On the target the way goes on to the destination, which lies on the lane that was left.
  EXPECT_EQ(at(70.0, 0.1).place->lane_id, "a0");
  EXPECT_EQ(at(100.0, 0.1).place->lane_id, "a0");
  EXPECT_EQ(at(200.0, 0.0).place->lane_id, "a1");
  const RouteUpdate back = at(250.0, 0.0);
  EXPECT_EQ(back.segments[0].next_action, ChangeLane::kRight);
  EXPECT_NEAR(back.place->distance_to_destination, 140.0, 1e-6);
}

TEST_F(LaneChangeTest, OverTheEndOfALane) {
  const LaneChangePlan found = plan(95.0, to_left(), 15.0);  // 60 m: on the next lane
  ASSERT_EQ(found.why_not, "");
  EXPECT_THAT(found.to, ElementsAre("a0", "a1"));
  ASSERT_EQ(map_.set_route(found.route).code, RouteCode::kOk);
  EXPECT_EQ(at(95.0, -3.5).segments.size(), 2u);
  EXPECT_EQ(at(120.0, -3.5).segments.size(), 2u);
  EXPECT_EQ(at(150.0, 0.0).place->lane_id, "a1");
}

TEST_F(LaneChangeTest, IsRefusedWithTheReason) {
  EXPECT_THAT(plan(50.0, to_lane("nowhere")).why_not, HasSubstr("'nowhere' is not in the lane graph"));
  EXPECT_THAT(plan(50.0, to_lane("a1")).why_not, HasSubstr("'a1' does not lie beside lane 'b0'"));
  EXPECT_THAT(plan(340.0, to_left(), 30.0).why_not, HasSubstr("60 m more, but 120 m are needed"));
  EXPECT_THAT(plan(375.0, to_left(), 0.0).why_not, HasSubstr("waypoint 1 of the route comes first, in 15 m"));
  make(test::grid(2, 4));  // b is the rightmost
  EXPECT_THAT(plan(50.0, {LaneChangeGoal::kRight, "", false}).why_not,
              HasSubstr("no lane to the right of lane 'b0'"));
}

TEST_F(LaneChangeTest, SolidPaintIsCrossedOnlyWhenForcedAndACurbNever) {
  LaneGraph graph = test::grid(3, 4);
  test::lane_of(graph, "b0").left_paint = {{0.0, BoundaryType::kDottedWhite},
                                           {60.0, BoundaryType::kSolidWhite}};
  make(graph);
  EXPECT_EQ(plan(20.0, to_left(), 10.0).why_not, "");  // 40 m of dots, 40 m are needed
  EXPECT_THAT(plan(20.5, to_left(), 10.0).why_not,
              HasSubstr("for 39.5 m more, but 40 m are needed: solid paint"));
  EXPECT_THAT(plan(70.0, to_left()).why_not, HasSubstr("must not be crossed"));
  EXPECT_EQ(plan(70.0, to_lane("a0", true)).why_not, "");
  EXPECT_EQ(plan(70.0, to_lane("c0")).why_not, "");
  test::lane_of(graph, "b0").left_paint = {{0.0, BoundaryType::kCurb}};
  make(graph);
  EXPECT_THAT(plan(70.0, to_lane("a0", true)).why_not, HasSubstr("it is a curb"));
}

TEST_F(LaneChangeTest, NoWayOnFromTheTargetIsAReason) {
  LaneGraph graph = test::grid(3, 4);
  for (GraphLane& lane : graph.lanes) {
    if (lane.id[0] == 'a') lane.right_paint = {{0.0, BoundaryType::kSolidWhite}};
  }
  make(graph);
  EXPECT_THAT(plan(50.0, to_left()).why_not, HasSubstr("from the target no way leads to the destination"));
}

TEST_F(LaneChangeTest, IsDoneWhenTheVehicleIsSeenThereTwice) {
  const LaneChangePlan found = plan(50.0, to_left());
  map_.set_route(found.route);
  LaneChange change(param_);
  change.begin(found.from, found.to, found.side, 100.0);
  RouteUpdate update = at(52.0, -3.5);
  change.update(update, 100.1);
  change.raise_target(update);
  EXPECT_EQ(update.segments[0].priority, 1u);
  EXPECT_EQ(update.segments[1].priority, 0u);
  EXPECT_TRUE(check_route(update, map_.index()).empty());
  change.update(at(54.0, 0.0), 100.2);  // a stray pose
  change.update(at(56.0, -3.4), 100.3);
  change.update(at(60.0, -0.8), 100.5);
  change.update(at(70.0, -0.4), 101.0);
  EXPECT_TRUE(change.is_on());
  update = at(71.0, -0.4);
  change.update(update, 101.1);
  EXPECT_EQ(change.status().state, LaneChangeState::kDone);
  change.raise_target(update);
  EXPECT_EQ(update.segments[0].priority, 0u);
}

TEST_F(LaneChangeTest, TimesOutOrIsAbandoned) {
  const LaneChangePlan found = plan(50.0, to_left());
  map_.set_route(found.route);
  LaneChange change(param_);
  change.abandon("nothing was on", 1.0);
  EXPECT_EQ(change.status().state, LaneChangeState::kNone);
  change.begin(found.from, found.to, found.side, 100.0);
  change.update(at(50.0, -3.5), 120.0);
  EXPECT_TRUE(change.is_on());
  change.update(at(50.0, -3.5), 120.1);
  EXPECT_EQ(change.status().state, LaneChangeState::kTimedOut);
  EXPECT_THAT(change.status().message, HasSubstr("has not come to lane 'a0' within 20 s"));
  change.begin(found.from, found.to, found.side, 200.0);
  change.update(at(50.0, -60.0), 200.1);
  EXPECT_EQ(change.status().state, LaneChangeState::kAbandoned);
  EXPECT_THAT(change.status().message, HasSubstr("no lane of the route"));
  change.begin(found.from, found.to, found.side, 300.0);
  change.update(at(50.0, -3.5), 20.0);
  EXPECT_THAT(change.status().message, HasSubstr("time has gone back"));
}

TEST(LaneChangeOnAMap, GoesToTheLaneBesideOnly) {
  RelativeMap map;
  for (int i = 0; i < 3; ++i) {
    Lane lane;
    lane.id = std::string(1, static_cast<char>('0' + i));
    for (const double x : {-10.0, 100.0}) {
      PathPoint point;
      point.position = {x, 3.5 - 3.5 * i};
      lane.path.push_back(point);
    }
    lane.remaining_distance = 100.0;
    if (i > 0) lane.left_neighbor_id = map.lanes.back().id;
    map.lanes.push_back(lane);
  }
  map.lanes[0].right_neighbor_id = "1";
  map.lanes[1].right_neighbor_id = "2";
  const LaneChangeParam param;
  EXPECT_EQ(plan_lane_change(map, "1", 10.0, param, to_left()).to.at(0), "0");
  EXPECT_EQ(plan_lane_change(map, "1", 10.0, param, to_lane("2")).side, ChangeLane::kRight);
  EXPECT_THAT(plan_lane_change(map, "0", 10.0, param, to_left()).why_not, HasSubstr("no lane to the left"));
  EXPECT_THAT(plan_lane_change(map, "0", 10.0, param, to_lane("2")).why_not,
              HasSubstr("does not lie beside"));
  EXPECT_THAT(plan_lane_change(map, "0", 10.0, param, to_lane("7")).why_not,
              HasSubstr("is not on the relative map"));
  EXPECT_THAT(plan_lane_change(map, "1", 30.0, param, to_left()).why_not, HasSubstr("120 m are needed"));
  map.lanes[1].left_boundary.paint = {{0.0, BoundaryType::kSolidYellow}};
  EXPECT_THAT(plan_lane_change(map, "1", 10.0, param, to_left()).why_not, HasSubstr("must not be crossed"));
  EXPECT_EQ(plan_lane_change(map, "1", 10.0, param, to_lane("0", true)).why_not, "");
}

}  // namespace
}  // namespace relative_map::core
