// Recorded lines as a lane graph: side by side, forks, merges and laps in closed form.
#include "relative_map/route/line_graph.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/route/route_search.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

LaneGraph graph_of(const std::vector<NamedLine>& lines) {
  std::vector<std::string> notes;
  LaneGraph graph = graph_from_lines(lines, LineGraphParam{}, notes);
  EXPECT_THAT(notes, IsEmpty());
  std::vector<GraphFault> faults;
  EXPECT_NE(LaneNetwork::prepare(graph, faults), nullptr);
  for (const GraphFault& fault : faults) ADD_FAILURE() << fault.what;
  return graph;
}

Polyline arc(const Point2& center, double radius, double from, double to) {
  Polyline points;
  const int steps = std::max(2, static_cast<int>(std::abs(to - from) * radius));
  for (int i = 0; i <= steps; ++i) {
    const double angle = from + (to - from) * i / steps;
    points.emplace_back(center + radius * Point2(std::cos(angle), std::sin(angle)));
  }
  return points;
}

Polyline joined(Polyline a, const Polyline& b) {
  a.insert(a.end(), b.begin() + 1, b.end());
  return a;
}

double length_of(const LaneGraph& graph) {
  double sum = 0.0;
  for (const GraphLane& lane : graph.lanes) sum += chord_length(lane.centerline);
  return sum;
}

TEST(LineGraph, TwoParallelLinesAreNeighbors) {
  LaneGraph graph = graph_of(
      {{"l", test::straight({0.0, 3.4}, {200.0, 3.4})}, {"r", test::straight({2.0, 0.0}, {201.0, 0.0})}});
  ASSERT_EQ(graph.lanes.size(), 2u);
  EXPECT_THAT(graph.lanes[0].right_neighbors, ElementsAre("r_0"));
  EXPECT_THAT(graph.lanes[0].left_neighbors, IsEmpty());
  EXPECT_THAT(graph.lanes[1].left_neighbors, ElementsAre("l_0"));
  EXPECT_NEAR(graph.lanes[0].right_width[0].width, 1.7, 1e-9);
  EXPECT_NEAR(graph.lanes[0].left_width[0].width, 1.75, 1e-9);
  EXPECT_NEAR(length_of(graph), 399.0, 1e-9);
}

TEST(LineGraph, OppositeAndCrossingLinesAreNone) {
  const LaneGraph graph = graph_of({{"there", test::straight({0.0, 0.0}, {200.0, 0.0})},
                                    {"back", test::straight({200.0, 3.5}, {0.0, 3.5})},
                                    {"across", test::straight({100.0, -100.0}, {100.0, 100.0})}});
  ASSERT_EQ(graph.lanes.size(), 3u);
  for (const GraphLane& lane : graph.lanes) {
    EXPECT_THAT(lane.left_neighbors, IsEmpty());
    EXPECT_THAT(lane.successors, IsEmpty());
  }
}

TEST(LineGraph, ALaneThatBeginsBesideAnotherCutsIt) {
  LaneGraph graph = graph_of({{"long", test::straight({0.0, 0.0}, {300.0, 0.0})},
                              {"short", test::straight({100.0, 3.5}, {200.0, 3.5})}});
  ASSERT_EQ(graph.lanes.size(), 4u);
  EXPECT_THAT(test::lane_of(graph, "short_0").right_neighbors, ElementsAre("long_1"));
  EXPECT_THAT(test::lane_of(graph, "long_0").successors, ElementsAre("long_1"));
  EXPECT_THAT(test::lane_of(graph, "long_1").successors, ElementsAre("long_2"));
  EXPECT_NEAR(chord_length(test::lane_of(graph, "long_1").centerline), 100.0, 2.0);
}

/// Straight on, and a bend to the left that leaves at x = 100: 1 m off after sqrt(2 R) = 10 m.
TEST(LineGraph, AForkIsFoundWhereTheLinesPart) {
  LaneGraph graph = graph_of(
      {{"on", test::straight({0.0, 0.0}, {200.0, 0.0})},
       {"off", joined(test::straight({0.0, 0.3}, {100.0, 0.0}), arc({100.0, 50.0}, 50.0, -kPi / 2, 0.0))}});
  ASSERT_EQ(graph.lanes.size(), 3u);
  GraphLane &before = test::lane_of(graph, "on_0"), &on = test::lane_of(graph, "on_1"), &off = graph.lanes[2];
  EXPECT_THAT(before.successors, ElementsAre("on_1", off.id));
  EXPECT_NEAR(chord_length(before.centerline), 110.0, 1.5);
  EXPECT_NEAR((off.centerline.front() - before.centerline.back()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((on.centerline.front() - before.centerline.back()).norm(), 0.0, 1e-9);
  EXPECT_NEAR((off.centerline.back() - Point2(150.0, 50.0)).norm(), 0.0, 1e-9);
  // No kink where it leaves.
  const LaneLine line(off.centerline);
  for (double s = 1.0; s < line.length(); s += 1.0)
    EXPECT_LT(std::abs(angle_difference(line.heading_at(s - 1.0), line.heading_at(s))), 0.12) << s;
}

TEST(LineGraph, AMergeIsAForkDrivenBackwards) {
  LaneGraph graph = graph_of(
      {{"on", test::straight({0.0, 0.0}, {200.0, 0.0})},
       {"in", joined(arc({100.0, 50.0}, 50.0, -kPi, -kPi / 2), test::straight({100.0, 0.0}, {200.0, 0.2}))}});
  ASSERT_EQ(graph.lanes.size(), 3u);
  EXPECT_THAT(test::lane_of(graph, "on_0").successors, ElementsAre("on_1"));
  EXPECT_THAT(test::lane_of(graph, "in_0").successors, ElementsAre("on_1"));
  EXPECT_NEAR(chord_length(test::lane_of(graph, "on_0").centerline), 90.0, 1.5);
}

TEST(LineGraph, LinesOneAfterTheOtherFollow) {
  const LaneGraph graph = graph_of(
      {{"b", test::straight({100.0, 0.2}, {200.0, 0.0})}, {"a", test::straight({0.0, 0.0}, {100.0, 0.0})}});
  ASSERT_EQ(graph.lanes.size(), 2u);
  EXPECT_THAT(graph.lanes[1].successors, ElementsAre("b_0"));
  EXPECT_THAT(graph.lanes[0].successors, IsEmpty());
}

TEST(LineGraph, ALapIsItsOwnSuccessor) {
  LaneGraph graph = graph_of({{"lap", arc({0.0, 0.0}, 50.0, 0.0, 2.0 * kPi - 0.03)}});
  ASSERT_EQ(graph.lanes.size(), 1u);
  EXPECT_THAT(graph.lanes[0].successors, ElementsAre("lap_0"));
  EXPECT_NEAR(length_of(graph), 2.0 * kPi * 50.0, 0.2);
}

TEST(LineGraph, AWayIsFoundOverALapWithASlipRoad) {
  const Polyline slip =
      joined(arc({0.0, 0.0}, 50.0, 0.5 * kPi, kPi), test::straight({-50.0, 0.0}, {-50.0, -100.0}));
  LaneGraph graph = graph_of({{"lap", arc({0.0, 0.0}, 50.0, 0.0, 2.0 * kPi)}, {"slip", slip}});
  ASSERT_EQ(graph.lanes.size(), 3u);
  RouteSearch search(test::prepared(graph), SearchParam{});
  SearchRequest request;
  // From behind the exit once around the lap, and out.
  request.places = {{"lap_1", 10.0}, {graph.lanes[2].id, 50.0}};
  const SearchResult found = search.find(request);
  ASSERT_TRUE(found.route) << found.why_not;
  EXPECT_NEAR(found.route->distance, 2.0 * kPi * 50.0 - 10.0 + 50.0, 1.0);
}

TEST(LineGraph, WhatIsNoLineIsNamed) {
  std::vector<std::string> notes;
  EXPECT_THAT(graph_from_lines({{"dot", {{0.0, 0.0}, {0.0, 0.0}}}}, LineGraphParam{}, notes).lanes,
              IsEmpty());
  EXPECT_THAT(notes, ElementsAre("line 'dot' has fewer than two points apart: it is left out"));
  EXPECT_THAT(graph_from_lines({}, LineGraphParam{}, notes).lanes, IsEmpty());
}

}  // namespace
}  // namespace relative_map::core
