// Each row of the contract, broken once.
#include "relative_map/route/route_check.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "relative_map/route/route_map.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

class RouteCheck : public testing::Test {
 protected:
  RouteCheck() : map_(RouteParam{}) {
    Route route;
    route.roads = {{"",
                    {test::passage({{"b0", 10.0, 100.0}, {"b1", 0.0, 100.0}}, ChangeLane::kLeft, false),
                     test::passage({{"a0", 0.0, 100.0}, {"a1", 0.0, 80.0}})}}};
    route.waypoints = {{"b0", 10.0, {}}, {"a1", 80.0, {}}};
    map_.set_graph(test::prepared(test::grid(2, 4)));
    map_.set_route(route);
    update_ = map_.update(Pose2({60.0, -3.5}, 0.0), 10.0);
  }

  /// Only this row is broken.
  void expect_broken(const std::string& row) {
    std::vector<std::string> broken;
    for (const RouteViolation& violation : check_route(update_, map_.index()))
      broken.push_back(violation.row);
    EXPECT_THAT(broken, testing::ElementsAre(row));
    const RouteUpdate instead = checked(update_, map_.index());
    EXPECT_EQ(instead.status.code, RouteCode::kContractViolation);
    EXPECT_THAT(instead.status.message, testing::HasSubstr(row));
    EXPECT_TRUE(instead.segments.empty());
    EXPECT_TRUE(check_route(instead, map_.index()).empty());
  }

  RouteMap map_;
  RouteUpdate update_;
};

TEST_F(RouteCheck, WhatIsRightPasses) {
  ASSERT_EQ(update_.segments.size(), 2u);
  EXPECT_TRUE(check_route(update_, map_.index()).empty());
  EXPECT_EQ(checked(update_, map_.index()).status.code, RouteCode::kOk);
  EXPECT_EQ(route_check_rows().size(), 11u);
}

TEST_F(RouteCheck, Status) {
  update_.status = {RouteCode::kOffRoute, "off"};
  expect_broken("status");
}
TEST_F(RouteCheck, StatusThatIsSilent) {
  update_ = {};
  update_.status.code = RouteCode::kOffRoute;
  expect_broken("status");
}
TEST_F(RouteCheck, Own) {
  std::swap(update_.segments[0], update_.segments[1]);
  std::swap(update_.segments[0].id, update_.segments[1].id);
  expect_broken("own");
}
TEST_F(RouteCheck, Ids) {
  update_.segments[1].id = update_.segments[0].id;
  expect_broken("ids");
}
TEST_F(RouteCheck, Pieces) {
  update_.segments[1].segments[0].start_s = std::numeric_limits<double>::quiet_NaN();
  expect_broken("pieces");
}
TEST_F(RouteCheck, Place) {
  update_.place->passage = 1;
  expect_broken("place");
}
TEST_F(RouteCheck, Actions) {
  update_.segments[1].previous_action = ChangeLane::kForward;
  expect_broken("actions");
}
TEST_F(RouteCheck, Priority) {
  update_.segments[1].priority = 0;
  expect_broken("priority");
}
TEST_F(RouteCheck, Count) {
  update_.segments.push_back(update_.segments[1]);
  update_.segments.back().id = "0_2";
  expect_broken("count");
}
TEST_F(RouteCheck, Lanes) {
  update_.segments[0].segments.back().end_s = 120.0;
  expect_broken("lanes");
}
TEST_F(RouteCheck, Continuity) {
  update_.segments[0].segments.front().end_s = 90.0;
  expect_broken("continuity");
}
TEST_F(RouteCheck, End) {
  update_.segments[1].route_end->s = 99.0;
  expect_broken("end");
}

}  // namespace
}  // namespace relative_map::core
