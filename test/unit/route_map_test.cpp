// What is told at each pose, fault by fault of the original: each test has the value that is right.
#include "relative_map/route/route_map.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "relative_map/route/route_check.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using test::passage;
using testing::ElementsAre;
using testing::HasSubstr;

/// A route, driven along pose by pose; what is told keeps the contract each time.
class Drive {
 public:
  Drive(const LaneGraph& graph, const Route& route) : map_(RouteParam{}) {
    map_.set_graph(test::prepared(graph));
    const RouteStatus status = map_.set_route(route);
    EXPECT_EQ(status.code, RouteCode::kOk) << status.message;
  }

  RouteUpdate at(double x, double y, double heading = 0.0, double speed = 10.0) {
    RouteUpdate update = map_.update(Pose2({x, y}, heading), speed);
    for (const RouteViolation& violation : check_route(update, map_.index())) {
      ADD_FAILURE() << "at " << x << ", " << y << ": " << violation.row << ": " << violation.what;
    }
    return update;
  }
  RouteMap& map() { return map_; }

 private:
  RouteMap map_;
};

std::vector<std::string> ids(const RouteUpdate& update) {
  std::vector<std::string> result;
  for (const RouteSegments& segments : update.segments) result.push_back(segments.id);
  return result;
}

std::string lanes(const RouteSegments& segments) {
  std::ostringstream text;
  for (const LaneSegment& piece : segments.segments) {
    text << piece.lane_id << "[" << piece.start_s << "," << piece.end_s << "] ";
  }
  return text.str();
}

Route keep() {
  return test::one_passage_roads(
      {{"a0", 10.0, 100.0}, {"a1", 0.0, 100.0}, {"a2", 0.0, 100.0}, {"a3", 0.0, 90.0}});
}

std::vector<LaneSegment> row(const std::string& name, double first, double last) {
  return {{name + "0", first, 100.0},
          {name + "1", 0.0, 100.0},
          {name + "2", 0.0, 100.0},
          {name + "3", 0.0, last}};
}

/// From the right row of three to the left one.
Route to_left() {
  Route route;
  route.roads = {
      {"r",
       {passage({{"c0", 10.0, 100.0}, {"c1", 0.0, 100.0}, {"c2", 0.0, 100.0}}, ChangeLane::kLeft, false),
        passage(row("b", 0.0, 100.0), ChangeLane::kLeft, false), passage(row("a", 0.0, 80.0))}}};
  route.waypoints = {{"c0", 10.0, {}}, {"a3", 80.0, {}}};
  return route;
}

/// Along a, over to b for a way point at b1 50, and back to a.
Route via() {
  Route route;
  route.roads = {{"r",
                  {passage(row("a", 10.0, 100.0), ChangeLane::kRight, false),
                   passage(row("b", 0.0, 100.0), ChangeLane::kLeft, false), passage(row("a", 0.0, 90.0))}}};
  route.waypoints = {{"a0", 10.0, {}}, {"b1", 50.0, {}}, {"a3", 90.0, {}}};
  return route;
}

TEST(RouteMap, TellsFiftyMetersBehindAndAHundredAndEightyAhead) {
  Drive drive(test::grid(1, 5), keep());
  const RouteUpdate update = drive.at(101.0, 0.5);
  ASSERT_EQ(ids(update), std::vector<std::string>{"1_0"});
  EXPECT_EQ(lanes(update.segments[0]), "a0[51,100] a1[0,100] a2[0,81] ");
  EXPECT_NEAR(update.segments[0].s, 50.0, 1e-9);
  EXPECT_NEAR(update.place->s, 1.0, 1e-9);
  EXPECT_NEAR(update.place->l, 0.5, 1e-9);
  EXPECT_NEAR(update.place->distance_to_destination, 99.0 + 100.0 + 90.0, 1e-9);
  EXPECT_TRUE(update.segments[0].route_end);
}

TEST(RouteMap, WithoutGraphRouteOrPoseItSaysSo) {
  RouteMap map{RouteParam{}};
  EXPECT_EQ(map.update(Pose2(), 0.0).status.code, RouteCode::kNoGraph);
  EXPECT_EQ(map.set_route(keep()).code, RouteCode::kNoGraph);
  map.set_graph(test::prepared(test::grid(1, 4)));
  EXPECT_EQ(map.update(Pose2(), 0.0).status.code, RouteCode::kNoRoute);
  map.set_route(keep());
  EXPECT_EQ(map.update(std::nullopt, 0.0).status.code, RouteCode::kNoLocalization);
  EXPECT_EQ(map.update(Pose2({std::numeric_limits<double>::quiet_NaN(), 0.0}, 0.0), 0.0).status.code,
            RouteCode::kNoLocalization);
}

TEST(Fault1, AfterAJumpBackTheVehicleIsFoundAtOnce) {
  Drive drive(test::grid(1, 4), keep());
  EXPECT_EQ(drive.at(350.0, 0.0).place->lane_id, "a3");
  EXPECT_EQ(drive.at(50.0, 0.0).place->lane_id, "a0");
  EXPECT_EQ(drive.at(50.5, 0.0).place->lane_id, "a0");
}

TEST(Fault2, AnAbandonedLaneChangeLeadsBackToTheOldPassage) {
  Drive drive(test::grid(3, 4), to_left());
  EXPECT_THAT(ids(drive.at(20.0, -5.4, 0.1)), ElementsAre("0_0", "0_1"));
  EXPECT_THAT(ids(drive.at(22.0, -5.1, 0.1)), ElementsAre("0_1", "0_2"));
  EXPECT_THAT(ids(drive.at(24.0, -6.8, -0.1)), ElementsAre("0_0", "0_1"));
  const RouteUpdate back = drive.at(26.0, -7.0);
  EXPECT_THAT(ids(back), ElementsAre("0_0", "0_1"));
  EXPECT_EQ(back.segments[1].previous_action, ChangeLane::kLeft);
}

TEST(Fault3, OfALaneThatTheRouteHasTwiceTheOneThatWasDrivenToIsTaken) {
  Drive drive(test::grid(2, 4), via());
  EXPECT_THAT(ids(drive.at(20.0, 0.0)), ElementsAre("0_0", "0_1"));
  EXPECT_THAT(ids(drive.at(90.0, -3.5)), ElementsAre("0_1"));
  EXPECT_THAT(ids(drive.at(155.0, -3.5)), ElementsAre("0_1", "0_2"));
  const RouteUpdate update = drive.at(180.0, 0.0);  // 25 m farther on, 250 m/s at 10 Hz
  EXPECT_THAT(ids(update), ElementsAre("0_2"));
  EXPECT_EQ(update.place->next_waypoint, 2u);
  EXPECT_TRUE(update.segments[0].stop_for_destination);
}

TEST(Fault3, AWayPointThatIsStillToComeIsNotSkipped) {
  Drive drive(test::grid(2, 4), via());
  EXPECT_THAT(ids(drive.at(90.0, -3.5)), ElementsAre("0_1"));
  const RouteUpdate back = drive.at(95.0, 0.0);
  EXPECT_THAT(ids(back), ElementsAre("0_0", "0_1"));
  EXPECT_EQ(back.place->next_waypoint, 1u);
}

TEST(Fault4, LapAfterLapIsCounted) {
  const double quarter = test::prepared(test::ring(4, 50.0))->lane(0).length();
  std::vector<LaneSegment> laps;
  for (int i = 0; i < 12; ++i) laps.push_back({"q" + std::to_string(i % 4), 0.0, quarter});
  Drive drive(test::ring(4, 50.0), test::one_passage_roads(laps));
  for (int step = 1; step < 12 * 39; ++step) {
    const double angle = 2.0 * kPi * step / (4 * 39);
    const RouteUpdate update =
        drive.at(50.0 * std::cos(angle), 50.0 * std::sin(angle), normalize_angle(angle + kPi / 2.0));
    ASSERT_TRUE(update.place) << update.status.message;
    EXPECT_NEAR(update.place->distance_to_destination, 12.0 * quarter * (1.0 - step / (12.0 * 39.0)), 1.0);
  }
}

TEST(Fault5, FarBesideTheRouteOrAcrossItIsNotOnIt) {
  Drive drive(test::grid(1, 4), keep());
  EXPECT_EQ(drive.at(120.0, 9.0).status.code, RouteCode::kOk);
  const RouteUpdate aside = drive.at(120.0, -60.0);
  EXPECT_EQ(aside.status.code, RouteCode::kOffRoute);
  EXPECT_THAT(aside.status.message, HasSubstr("10 m"));
  EXPECT_EQ(drive.at(120.0, 0.0, 1.4).status.code, RouteCode::kOk);
  EXPECT_EQ(drive.at(120.0, 0.0, 1.7).status.code, RouteCode::kWrongWay);
  EXPECT_EQ(drive.at(120.0, 0.0, -2.3).status.code, RouteCode::kWrongWay);
  EXPECT_EQ(drive.at(120.0, 0.0, 0.0).status.code, RouteCode::kOk);
}

TEST(Fault6, ALittlePastTheDestinationTheVehicleIsStillThere) {
  Drive drive(test::grid(1, 4), keep());
  drive.at(389.9, 0.0);
  for (const double past : {0.1, 0.3, 0.5, 2.0, 8.0}) {
    const RouteUpdate update = drive.at(390.0 + past, 0.0);
    ASSERT_EQ(update.status.code, RouteCode::kOk) << past;
    EXPECT_EQ(update.place->lane_id, "a3");
    EXPECT_NEAR(update.place->s, 90.0 + past, 1e-9);
    EXPECT_NEAR(update.place->distance_to_destination, -past, 1e-9);
    EXPECT_TRUE(update.segments[0].stop_for_destination);
  }
  EXPECT_EQ(drive.at(415.0, 0.0).status.code, RouteCode::kRouteEnd);
}

TEST(Fault6, OnTheOuterSideOfACornerTheVehicleIsOnTheRoute) {
  LaneGraph graph;
  graph.lanes = {test::make_lane("c1", test::straight({0.0, 0.0}, {60.0, 0.0})),
                 test::make_lane("c2", test::straight({60.0, 0.0}, {60.0, -60.0}))};
  test::follow(graph, "c1", "c2");
  Drive drive(graph, test::one_passage_roads({{"c1", 5.0, 60.0}, {"c2", 0.0, 50.0}}));
  for (double part = 0.0; part <= 1.0; part += 0.05) {
    const double angle = kPi / 2.0 * part;  // on a circle around the corner
    const RouteUpdate update = drive.at(60.0 + 1.5 * std::sin(angle), 1.5 * std::cos(angle), -angle);
    EXPECT_EQ(update.status.code, RouteCode::kOk) << part;
  }
}

TEST(Fault7, AVehicleInAHoleOfTheRouteIsOnIt) {
  Route route;
  route.roads = {{"", {passage({{"a0", 10.0, 40.0}, {"a1", 0.0, 100.0}, {"a2", 0.0, 90.0}})}}};
  route.waypoints = {{"a0", 10.0, {}}, {"a2", 90.0, {}}};
  Drive drive(test::grid(1, 4), route);
  const RouteUpdate update = drive.at(70.0, 0.0);
  EXPECT_EQ(lanes(update.segments.at(0)), "a0[20,100] a1[0,100] a2[0,50] ");
}

TEST(Fault8, APieceWithoutLengthDoesNotHideALane) {
  Route route;
  route.roads = {{"", {passage({{"a0", 10.0, 100.0}})}},
                 {"", {passage({{"a1", 0.0, 100.0}, {"a2", 0.0, 0.0}})}}};
  route.waypoints = {{"a0", 10.0, {}}, {"a2", 0.0, {}}};
  Drive drive(test::grid(1, 4), route);
  // The destination is the start of a2: it is there to be found, nothing is missing before it, and nothing is
  // told past it.
  EXPECT_EQ(lanes(drive.at(60.0, 0.0).segments.at(0)), "a0[10,100] a1[0,100] a2[0,0.2] ");
}

TEST(Fault9, ThePassageToChangeToIsTheNextOfTheRoute) {
  Drive drive(test::grid(2, 4), via());
  drive.at(90.0, -3.5);
  const RouteUpdate update = drive.at(155.0, -3.5);
  EXPECT_THAT(ids(update), ElementsAre("0_1", "0_2"));
  EXPECT_EQ(update.segments[1].previous_action, ChangeLane::kLeft);
}

TEST(Fault9, BeforeItsWayPointIsPassedThereIsNothingToChangeTo) {
  Drive drive(test::grid(2, 4), via());
  EXPECT_THAT(ids(drive.at(140.0, -3.5)), ElementsAre("0_1"));
}

TEST(Fault10, AClosedLaneGoesOnThroughItsSeam) {
  const LaneGraph graph = test::ring(1, 50.0);
  const double lap = test::prepared(graph)->lane(0).length();
  Drive drive(graph, test::one_passage_roads({{"q0", 10.0, 300.0}}));
  const auto at = [&](double s) {
    const double angle = s / lap * 2.0 * kPi;
    return drive.at(50.0 * std::cos(angle), 50.0 * std::sin(angle), normalize_angle(angle + kPi / 2.0));
  };
  for (const double s : {20.0, 290.0}) {
    const RouteUpdate update = at(s);
    ASSERT_EQ(update.segments.size(), 1u) << update.status.message;
    EXPECT_NEAR(update.segments[0].length(), 230.0, 1e-6) << s;
    EXPECT_EQ(update.segments[0].segments.size(), 2u);
  }
}

TEST(Fault11, PastTheEndOfALaneOfOneChordIsSeen) {
  LaneGraph graph;
  graph.lanes = {test::make_lane("on", {{120.0, -20.0}, {180.0, -20.0}}),
                 test::make_lane("far", {{180.0, -20.0}, {180.0, -80.0}})};
  test::follow(graph, "on", "far");
  Drive drive(graph, test::one_passage_roads({{"on", 0.0, 60.0}, {"far", 0.0, 50.0}}));
  EXPECT_EQ(drive.at(220.0, -20.0, 0.0).status.code, RouteCode::kOffRoute);
}

TEST(Fault12And18, TheDestinationIsTheEnd) {
  LaneGraph graph = test::grid(1, 4);
  graph.lanes.push_back(test::make_lane("wrong", test::straight({400.0, 0.0}, {500.0, 30.0})));
  test::follow(graph, "a3", "wrong");
  for (const double end : {90.0, 95.0, 99.95, 100.0}) {
    Route route = keep();
    route.roads[3].passages[0].segments[0].end_s = end;
    route.waypoints.back().s = end;
    Drive drive(graph, route);
    for (const double x : {250.0, 330.0, 389.0}) {
      const RouteUpdate update = drive.at(x, 0.0);
      EXPECT_EQ(update.segments.at(0).segments.back().lane_id, "a3");
      EXPECT_NEAR(update.segments.at(0).segments.back().end_s, end, 1e-9);
    }
  }
}

// The way past a passage that does not lead on takes the lanes that the route has later, not the first link.
TEST(Fault18, AForkIsTakenAsTheRouteTakesIt) {
  LaneGraph graph = test::grid(1, 1);
  graph.lanes.push_back(test::make_lane("wrong", test::straight({100.0, 0.0}, {200.0, 40.0})));
  graph.lanes.push_back(test::make_lane("right", test::straight({100.0, 0.0}, {200.0, -40.0})));
  test::follow(graph, "a0", "wrong");
  test::follow(graph, "a0", "right");
  Drive drive(graph, test::one_passage_roads({{"a0", 10.0, 100.0}, {"right", 0.0, 60.0}}));
  EXPECT_EQ(lanes(drive.at(80.0, 0.0).segments.at(0)), "a0[30,100] right[0,60] ");
}

TEST(Fault14, ALapThatEndsWhereItStartsIsDrivenBeforeTheStop) {
  const LaneGraph graph = test::ring(4, 50.0);
  const double quarter = test::prepared(graph)->lane(0).length();
  Drive drive(graph, test::one_passage_roads({{"q0", 10.0, quarter},
                                              {"q1", 0.0, quarter},
                                              {"q2", 0.0, quarter},
                                              {"q3", 0.0, quarter},
                                              {"q0", 0.0, 10.0}}));
  const auto at = [&](double s) {
    const double angle = s / quarter * kPi / 2.0;
    return drive.at(50.0 * std::cos(angle), 50.0 * std::sin(angle), normalize_angle(angle + kPi / 2.0));
  };
  EXPECT_FALSE(at(9.9).segments.at(0).stop_for_destination);
  for (double s = 10.0; s < 120.0; s += 2.0) EXPECT_FALSE(at(s).segments.at(0).stop_for_destination) << s;
  for (double s = 120.0; s < 320.0; s += 2.0) at(s);
  EXPECT_TRUE(at(321.0).segments.at(0).stop_for_destination);
  const RouteUpdate arrived = at(324.4);
  EXPECT_LT(arrived.place->distance_to_destination, 0.0);
  EXPECT_EQ(arrived.place->segment, 4u);
}

TEST(Fault14, ReversingTakesTheStopBack) {
  Route route = keep();
  route.waypoints.insert(route.waypoints.begin() + 1, {"a1", 50.0, {}});
  Drive drive(test::grid(1, 4), route);
  EXPECT_FALSE(drive.at(149.0, 0.0).segments[0].stop_for_destination);
  EXPECT_TRUE(drive.at(151.0, 0.0).segments[0].stop_for_destination);
  EXPECT_FALSE(drive.at(149.0, 0.0).segments[0].stop_for_destination);
}

TEST(Fault15, ABadRouteLeavesTheOldOneInPlace) {
  Drive drive(test::grid(1, 4), keep());
  drive.at(150.0, 0.0);
  Route bad = keep();
  bad.roads[2].passages[0].segments[0].lane_id = "gone";
  EXPECT_EQ(drive.map().set_route(bad).code, RouteCode::kUnknownLane);
  EXPECT_EQ(drive.at(151.0, 0.0).status.code, RouteCode::kOk);
  // It is as new the second time.
  EXPECT_EQ(drive.map().set_route(bad).code, RouteCode::kUnknownLane);
}

TEST(Fault16, TheSameRouteAgainForgetsNothing) {
  Drive drive(test::grid(2, 4), via());
  drive.at(155.0, -3.5);
  Route again = via();
  again.id = "a new stamp";
  EXPECT_EQ(drive.map().set_route(again).code, RouteCode::kOk);
  EXPECT_THAT(ids(drive.at(160.0, 0.0)), ElementsAre("0_2"));
}

TEST(Fault17, BehindAMergeTheArmIsTheRoutes) {
  LaneGraph graph;
  graph.lanes = {test::make_lane("in", test::straight({0.0, 0.0}, {60.0, 0.0})),
                 test::make_lane("side", test::straight({0.0, -30.0}, {60.0, 0.0})),
                 test::make_lane("on", test::straight({60.0, 0.0}, {160.0, 0.0}))};
  test::follow(graph, "side", "on");
  test::follow(graph, "in", "on");
  Drive drive(graph, test::one_passage_roads({{"in", 5.0, 60.0}, {"on", 0.0, 90.0}}));
  EXPECT_EQ(lanes(drive.at(90.0, 0.0).segments.at(0)), "in[40,60] on[0,90] ");
}

TEST(Fault24, TheLookAheadGrowsWithoutAStepAndIsNeverLessThanEightSeconds) {
  const RouteParam param;
  EXPECT_EQ(param.ahead(0.0), 180.0);
  EXPECT_EQ(param.ahead(22.5), 180.0);
  EXPECT_EQ(param.ahead(24.0), 250.0);
  EXPECT_EQ(param.ahead(40.0), 320.0);
  EXPECT_EQ(param.ahead(std::numeric_limits<double>::quiet_NaN()), 180.0);
  for (double v = 0.0; v < 60.0; v += 0.01) {
    EXPECT_LT(param.ahead(v + 0.01) - param.ahead(v), 0.5);
    EXPECT_GE(param.ahead(v), 8.0 * v - 1e-9);
  }
}

TEST(RouteMap, LanesThatLieTooFarApartAreNotChangedBetween) {
  LaneGraph graph = test::grid(2, 4);
  for (GraphLane& lane : graph.lanes) lane.left_width = lane.right_width = {{0.0, 1.2}};
  Drive drive(graph, via());
  EXPECT_THAT(ids(drive.at(20.0, 0.0)), ElementsAre("0_0"));  // 1.1 m of something between them
}

TEST(RouteMap, TellsWhereTheLaneChangeHasToBeDone) {
  Route route;
  route.roads = {
      {"r",
       {passage({{"c0", 10.0, 100.0}, {"c1", 0.0, 100.0}, {"c2", 0.0, 100.0}}, ChangeLane::kLeft, false),
        passage({{"b1", 0.0, 100.0}, {"b2", 0.0, 80.0}})}}};
  route.waypoints = {{"c0", 10.0, {}}, {"b2", 80.0, {}}};
  Drive drive(test::grid(3, 4), route);
  const RouteUpdate before = drive.at(60.0, -7.0);
  EXPECT_EQ(before.segments.size(), 1u);  // b1 is not beside the vehicle yet
  ASSERT_TRUE(before.segments[0].change);
  EXPECT_NEAR(before.segments[0].change->begin, 40.0, 1e-9);
  EXPECT_NEAR(before.segments[0].change->end, 240.0, 1e-9);
  const RouteUpdate beside = drive.at(120.0, -7.0);
  EXPECT_EQ(beside.segments.size(), 2u);
  EXPECT_EQ(beside.segments[0].change->begin, 0.0);
  EXPECT_FALSE(beside.segments[1].change);
}

TEST(RouteMap, ANewGraphKeepsARouteThatFitsIt) {
  Drive drive(test::grid(1, 4), keep());
  EXPECT_EQ(drive.map().set_graph(test::prepared(test::grid(2, 5))).code, RouteCode::kOk);
  EXPECT_EQ(drive.at(50.0, 0.0).status.code, RouteCode::kOk);
  EXPECT_EQ(drive.map().set_graph(test::prepared(test::grid(1, 2))).code, RouteCode::kUnknownLane);
  EXPECT_EQ(drive.at(50.0, 0.0).status.code, RouteCode::kNoRoute);
}

}  // namespace
}  // namespace relative_map::core
