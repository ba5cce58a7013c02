// Faults of the original that are no matter of a whole drive; the others are in route_map_test.cpp.
#include <gmock/gmock.h>

#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_identity.hpp"
#include "relative_map/route/route_line.hpp"
#include "relative_map/route/route_map.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

Route keep() {
  return test::one_passage_roads({{"a0", 10.0, 100.0}, {"a1", 0.0, 100.0}, {"a2", 0.0, 90.0}});
}

// Pieces of one lane are one only where they meet: a lap is not folded into its first piece.
TEST(Fault19, PiecesOfALaneThatDoNotMeetStayApart) {
  std::vector<LanePiece> line;
  append(line, {0, 10.0, 50.0});
  append(line, {0, 50.0, 60.0});
  EXPECT_EQ(line.size(), 1u);
  append(line, {0, 0.0, 10.0});
  EXPECT_EQ(line.size(), 2u);
  append(line, {1, 0.0, 10.0});
  append(line, {0, 10.0, 20.0});
  EXPECT_EQ(line.size(), 4u);
}

// The original always gives the first span of a boundary.
TEST(Fault21, PaintIsThatOfThePlace) {
  LaneGraph graph = test::grid(1, 3);
  test::lane_of(graph, "a1").right_paint = {{0.0, BoundaryType::kDottedWhite}, {50.0, BoundaryType::kCurb}};
  RouteMap map{RouteParam{}};
  map.set_graph(test::prepared(graph));
  ASSERT_EQ(map.set_route(keep()).code, RouteCode::kOk);
  ReferenceLineMaker maker(test::prepared(graph), ReferenceLineParam{});
  const RouteUpdate update = map.update(Pose2({110.0, 0.0}, 0.0), 10.0);
  const ReferenceLine line = maker.make(update.segments, {110.0, 0.0}).at(0);
  double before = 0.0, beside = 0.0;
  for (const ReferencePoint& point : line.points) {
    if (std::abs(point.path.position.x() - 105.0) < 0.6) before = point.l;
    if (std::abs(point.path.position.x() - 175.0) < 0.6) beside = point.l;
  }
  EXPECT_LT(std::abs(before), 0.03);
  EXPECT_GT(beside, 0.05);
}

// The original then gives an infinite offset and calls it found.
TEST(Fault22, WhereNoChordPointsTheVehiclesWayItIsTheWrongWay) {
  RouteMap map{RouteParam{}};
  map.set_graph(test::prepared(test::grid(1, 3)));
  ASSERT_EQ(map.set_route(keep()).code, RouteCode::kOk);
  const RouteUpdate update = map.update(Pose2({110.0, 0.0}, kPi), 10.0);
  EXPECT_EQ(update.status.code, RouteCode::kWrongWay);
  EXPECT_FALSE(update.place);
}

// Passage ids are places in a route: what remembers one has to know of which.
TEST(Fault23, AnotherRouteHasAnotherIdentity) {
  Route route = keep(), same = keep();
  same.id = "a new stamp";
  same.distance = 1.0;
  EXPECT_EQ(route_identity(route), route_identity(same));
  EXPECT_EQ(route_identity(route).size(), 16u);
  same.roads[2].passages[0].segments[0].end_s = 89.0;
  EXPECT_NE(route_identity(route), route_identity(same));
  same = keep();
  same.waypoints[0].s = 11.0;
  EXPECT_NE(route_identity(route), route_identity(same));
  same = keep();
  same.roads[0].passages[0].can_exit = false;
  EXPECT_NE(route_identity(route), route_identity(same));
}

}  // namespace
}  // namespace relative_map::core
