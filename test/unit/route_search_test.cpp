#include "relative_map/route/route_search.hpp"

#include <gmock/gmock.h>

#include "relative_map/route/route_index.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using testing::HasSubstr;

std::string text(const Route& route) {
  std::ostringstream all;
  for (const RouteRoad& road : route.roads) {
    all << "|";
    for (const Passage& passage : road.passages) {
      all << (passage.can_exit ? "X " : passage.change_lane == ChangeLane::kLeft ? "L " : "R ");
      for (const LaneSegment& segment : passage.segments) {
        all << segment.lane_id << "[" << segment.start_s << "," << segment.end_s << "] ";
      }
    }
  }
  return all.str();
}

SearchResult found(const LaneGraph& graph, const SearchRequest& request, const SearchParam& param = {}) {
  const auto network = test::prepared(graph);
  SearchResult result = RouteSearch(network, param).find(request);
  if (result.route) {
    const RouteIndex::Result index = RouteIndex::build(network, *result.route);
    EXPECT_NE(index.index, nullptr) << index.status.message << text(*result.route);
    EXPECT_TRUE(index.repairs.empty());
  }
  return result;
}

std::string way(const LaneGraph& graph, const SearchRequest& request, const SearchParam& param = {}) {
  const SearchResult result = found(graph, request, param);
  return result.route ? text(*result.route) : result.why_not;
}

TEST(RouteSearch, StraightOnIsARoadForEachLane) {
  EXPECT_EQ(way(test::grid(1, 3), {{{"a0", 10.0}, {"a2", 30.0}}, {}}),
            "|X a0[10,100] |X a1[0,100] |X a2[0,30] ");
  EXPECT_NEAR(found(test::grid(1, 3), {{{"a0", 10.0}, {"a2", 30.0}}, {}}).route->distance, 220.0, 1e-9);
}

TEST(RouteSearch, WithinOneLane) {
  EXPECT_EQ(way(test::grid(1, 3), {{{"a1", 10.0}, {"a1", 30.0}}, {}}), "|X a1[10,30] ");
}

TEST(RouteSearch, RowsBesideEachOtherAreOneRoad) {
  EXPECT_EQ(way(test::grid(2, 3), {{{"b0", 10.0}, {"a2", 80.0}}, {}}).substr(0, 2), "|L");
  const Route route = *found(test::grid(2, 3), {{{"b0", 10.0}, {"a2", 80.0}}, {}}).route;
  ASSERT_EQ(route.roads.size(), 1u) << text(route);
  ASSERT_EQ(route.roads[0].passages.size(), 2u) << text(route);
  EXPECT_NEAR(route.distance, 270.0, 1e-9);
}

TEST(RouteSearch, ADestinationBehindTheStartIsALap) {
  const LaneGraph graph = test::ring(4, 50.0);
  const double quarter = test::prepared(graph)->lane(0).length();
  const SearchResult lap = found(graph, {{{"q0", 10.0}, {"q0", 5.0}}, {}});
  ASSERT_TRUE(lap.route) << lap.why_not;
  EXPECT_EQ(lap.route->roads.size(), 5u) << text(*lap.route);
  EXPECT_NEAR(lap.route->distance, 4.0 * quarter - 5.0, 1e-9);
  const SearchResult closed = found(test::ring(1, 50.0), {{{"q0", 10.0}, {"q0", 5.0}}, {}});
  ASSERT_TRUE(closed.route) << closed.why_not;
  EXPECT_NEAR(closed.route->distance, test::prepared(test::ring(1, 50.0))->lane(0).length() - 5.0, 1e-9);
  EXPECT_THAT(way(test::grid(2, 3), {{{"a1", 50.0}, {"a1", 40.0}}, {}}),
              HasSubstr("no way leads from 50 m of lane 'a1'"));
  // Nor over the lane beside it and back.
  EXPECT_THAT(way(test::grid(2, 3), {{{"a1", 50.0}, {"b1", 40.0}}, {}}), HasSubstr("no way leads"));
}

TEST(RouteSearch, OverAWayPointOnTheNextLaneAndBack) {
  const Route route = *found(test::grid(2, 4), {{{"a0", 10.0}, {"b1", 50.0}, {"a3", 90.0}}, {}}).route;
  ASSERT_EQ(route.roads.size(), 1u) << text(route);
  ASSERT_EQ(route.roads[0].passages.size(), 3u) << text(route);
  EXPECT_EQ(route.roads[0].passages[0].change_lane, ChangeLane::kRight);
  EXPECT_EQ(route.roads[0].passages[1].change_lane, ChangeLane::kLeft);
  EXPECT_NEAR(route.distance, 380.0, 1e-9);
}

TEST(RouteSearch, PaintThatIsNotDottedIsNotCrossed) {
  LaneGraph graph = test::grid(2, 3);
  for (GraphLane& lane : graph.lanes) lane.left_paint = lane.right_paint = {{0.0, BoundaryType::kSolidWhite}};
  EXPECT_THAT(way(graph, {{{"b0", 10.0}, {"a2", 80.0}}, {}}), HasSubstr("no way leads"));
  // It may be crossed on one piece only: there.
  test::lane_of(graph, "b1").left_paint = {{0.0, BoundaryType::kDottedWhite}};
  EXPECT_EQ(way(graph, {{{"b0", 10.0}, {"a2", 80.0}}, {}}),
            "|X b0[10,100] |L b1[0,100] X a1[0,100] |X a2[0,80] ");
  test::lane_of(graph, "b1").left_paint.clear();
  EXPECT_EQ(way(graph, {{{"b0", 10.0}, {"a2", 80.0}}, {}}),
            "|X b0[10,100] |L b1[0,100] X a1[0,100] |X a2[0,80] ");
  test::lane_of(graph, "a1").type = LaneType::kBiking;
  EXPECT_THAT(way(graph, {{{"b0", 10.0}, {"a2", 80.0}}, {}}), HasSubstr("no way leads"));
}

TEST(RouteSearch, ClosedLanesAreLeftOut) {
  EXPECT_THAT(way(test::grid(1, 3), {{{"a0", 10.0}, {"a2", 80.0}}, {"a1"}}), HasSubstr("no way leads"));
  EXPECT_THAT(way(test::grid(1, 3), {{{"a0", 10.0}, {"a2", 80.0}}, {"a2"}}), HasSubstr("'a2' is closed"));
  const Route around = *found(test::grid(2, 3), {{{"a0", 10.0}, {"a2", 80.0}}, {"a1"}}).route;
  for (const RouteRoad& road : around.roads) {
    for (const Passage& passage : road.passages) {
      for (const LaneSegment& segment : passage.segments) EXPECT_NE(segment.lane_id, "a1") << text(around);
    }
  }
}

TEST(RouteSearch, ABadRequestIsASentence) {
  const LaneGraph graph = test::grid(1, 2);
  EXPECT_THAT(way(graph, {{{"a0", 10.0}}, {}}), HasSubstr("needs a start and a destination"));
  EXPECT_THAT(way(graph, {{{"gone", 10.0}, {"a1", 1.0}}, {}}), HasSubstr("'gone' is not in the lane graph"));
  EXPECT_THAT(way(graph, {{{"a0", 110.0}, {"a1", 1.0}}, {}}), HasSubstr("100 m long: 110 m is not on it"));
  EXPECT_THAT(way(graph, {{{"a0", std::nan("")}, {"a1", 1.0}}, {}}), HasSubstr("is not on it"));
}

TEST(RouteSearch, ASearchLeavesNothingBehind) {
  const auto network = test::prepared(test::grid(3, 4));
  RouteSearch search(network, SearchParam{});
  const SearchRequest one{{{"a0", 10.0}, {"c3", 80.0}}, {}}, other{{{"c1", 50.0}, {"a1", 70.0}}, {}};
  const std::string first = text(*search.find(one).route), second = text(*search.find(other).route);
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(text(*search.find(one).route), first);
    EXPECT_EQ(text(*search.find(other).route), second);
  }
}

TEST(RouteSearch, FasterRoadsAndFewerTurnsCostLess) {
  LaneGraph graph;
  graph.lanes = {test::make_lane("in", test::straight({0.0, 0.0}, {50.0, 0.0})),
                 test::make_lane("slow", test::straight({50.0, 0.0}, {150.0, 0.0})),
                 test::make_lane("fast", {{50.0, 0.0}, {100.0, 30.0}, {150.0, 0.0}}),
                 test::make_lane("out", test::straight({150.0, 0.0}, {200.0, 0.0}))};
  for (const char* middle : {"slow", "fast"}) {
    test::follow(graph, "in", middle);
    test::follow(graph, middle, "out");
  }
  test::lane_of(graph, "slow").speed_limit = 5.0;
  test::lane_of(graph, "fast").speed_limit = 20.0;
  const SearchRequest request{{{"in", 0.0}, {"out", 50.0}}, {}};
  EXPECT_THAT(way(graph, request), HasSubstr("fast"));
  test::lane_of(graph, "fast").turn = LaneTurn::kLeftTurn;
  EXPECT_THAT(way(graph, request), HasSubstr("slow"));
  test::lane_of(graph, "fast").turn = LaneTurn::kNoTurn;
  test::lane_of(graph, "slow").speed_limit = 20.0;
  EXPECT_THAT(way(graph, request), HasSubstr("slow"));
}

}  // namespace
}  // namespace relative_map::core
