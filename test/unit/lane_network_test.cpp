#include "relative_map/route/lane_network.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

using testing::HasSubstr;

std::string fatal_fault(const LaneGraph& graph) {
  std::vector<GraphFault> faults;
  EXPECT_EQ(LaneNetwork::prepare(graph, faults), nullptr);
  for (const GraphFault& fault : faults) {
    if (fault.fatal) return fault.what;
  }
  return "";
}

TEST(LaneNetwork, AGraphThatCannotBeUsedIsRefusedByName) {
  EXPECT_THAT(fatal_fault({}), HasSubstr("no lane"));
  LaneGraph graph = test::grid(1, 2);
  graph.lanes[1].id = "a0";
  EXPECT_THAT(fatal_fault(graph), HasSubstr("two lanes are called 'a0'"));
  graph = test::grid(1, 2);
  graph.lanes[1].centerline[3].x() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(fatal_fault(graph), HasSubstr("lane 'a1' has a point that is not finite"));
  graph = test::grid(1, 2);
  graph.lanes[1].centerline = {{5.0, 5.0}, {5.0, 5.0}};
  EXPECT_THAT(fatal_fault(graph), HasSubstr("lane 'a1' has fewer than two points"));
  graph = test::grid(1, 2);
  graph.lanes[1].left_width = {{0.0, std::numeric_limits<double>::infinity()}};
  EXPECT_THAT(fatal_fault(graph), HasSubstr("lane 'a1' has a width"));
  graph = test::grid(1, 2);
  graph.lanes[0].speed_limit = -1.0;
  EXPECT_THAT(fatal_fault(graph), HasSubstr("lane 'a0' has no speed limit"));
}

TEST(LaneNetwork, AllFaultsAreTold) {
  LaneGraph graph = test::grid(1, 3);
  graph.lanes[0].centerline.clear();
  graph.lanes[2].centerline.clear();
  std::vector<GraphFault> faults;
  EXPECT_EQ(LaneNetwork::prepare(graph, faults), nullptr);
  EXPECT_EQ(faults.size(), 2u);
}

// A map is often a part of another: its edge lanes have successors that are not in it.
TEST(LaneNetwork, ALinkToNowhereIsToldAndLeftOut) {
  LaneGraph graph = test::grid(1, 2);
  graph.lanes[1].successors.push_back("elsewhere");
  std::vector<GraphFault> faults;
  const auto network = LaneNetwork::prepare(graph, faults);
  ASSERT_NE(network, nullptr);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_FALSE(faults[0].fatal);
  EXPECT_THAT(faults[0].what, HasSubstr("'elsewhere'"));
  EXPECT_TRUE(network->lane(1).successors.empty());
}

TEST(LaneNetwork, ALinkThatIsNamedAtOneEndIsOne) {
  LaneGraph graph = test::grid(1, 3);
  test::lane_of(graph, "a1").predecessors.clear();
  test::lane_of(graph, "a1").successors.clear();
  const auto network = test::prepared(graph);
  EXPECT_EQ(network->lane(1).predecessors, std::vector<std::size_t>{0});
  EXPECT_EQ(network->lane(1).successors, std::vector<std::size_t>{2});
  EXPECT_EQ(network->lane(2).predecessors, std::vector<std::size_t>{1});
}

TEST(LaneNetwork, SuccessorsThatDoNotMeetAreTold) {
  LaneGraph graph = test::grid(1, 2);
  for (Point2& point : graph.lanes[1].centerline) point.y() += 4.0;
  std::vector<GraphFault> faults;
  ASSERT_NE(LaneNetwork::prepare(graph, faults), nullptr);
  ASSERT_EQ(faults.size(), 1u);
  EXPECT_THAT(faults[0].what, HasSubstr("lane 'a0' ends 4 m from where its successor 'a1' starts"));
}

TEST(LaneNetwork, FindsLanesByWhereTheyLie) {
  const auto network = test::prepared(test::grid(3, 4));
  const auto near = network->lanes_near({150.0, 0.0}, 2.0);
  EXPECT_EQ(near, std::vector<std::size_t>{*network->find("a1")});
  EXPECT_EQ(network->lanes_near({150.0, -3.5}, 4.0).size(), 3u);
  EXPECT_TRUE(network->lanes_near({150.0, 100.0}, 10.0).empty());
}

TEST(LaneNetwork, KnowsClosedLanes) {
  const auto closed = test::prepared(test::ring(1, 50.0));
  EXPECT_TRUE(closed->lane(0).closed);
  EXPECT_FALSE(test::prepared(test::ring(4, 50.0))->lane(0).closed);
}

TEST(LaneNetwork, HalfWidthsAreLinearBetweenSamplesAndHeldAtTheEnds) {
  LaneGraph graph = test::grid(1, 1);
  graph.lanes[0].left_width = {{10.0, 1.0}, {20.0, 3.0}};
  graph.lanes[0].right_width.clear();
  const auto network = test::prepared(graph);
  EXPECT_EQ(network->lane(0).left_half_width(0.0), 1.0);
  EXPECT_NEAR(network->lane(0).left_half_width(15.0), 2.0, 1e-12);
  EXPECT_EQ(network->lane(0).left_half_width(99.0), 3.0);
  EXPECT_EQ(network->lane(0).right_half_width(15.0), 0.0);
}

}  // namespace
}  // namespace relative_map::core
