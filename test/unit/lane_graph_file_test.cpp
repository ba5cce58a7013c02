#include "relative_map/io/lane_graph_file.hpp"

#include <gmock/gmock.h>

#include <fstream>

#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using testing::HasSubstr;

class LaneGraphFile : public test::TemporaryFolder {
 protected:
  std::string file(const std::string& content) { return write("graph.json", content); }
  std::string graph_fault(const std::string& content) {
    return test::fault_of([&] { read_lane_graph(file(content)); });
  }
  std::string route_fault(const std::string& content) {
    return test::fault_of([&] { read_route(file(content)); });
  }
};

TEST_F(LaneGraphFile, IsReadAsItWasWritten) {
  GraphLane lane;
  lane.id = "one";
  lane.centerline = {{586438.1562, 4140731.6854}, {586442.6949, 4140748.9574}};
  lane.left_width = {{0.0, 1.5}, {17.8, 1.6}};
  lane.right_width = {{0.0, 1.75}};
  lane.successors = {"two", "three"};
  lane.left_reverse = {"back"};
  lane.left_paint = {{0.0, BoundaryType::kDoubleYellow}, {9.0, BoundaryType::kDottedWhite}};
  lane.speed_limit = 8.333;
  lane.type = LaneType::kBiking;
  lane.turn = LaneTurn::kUTurn;
  lane.road = "1272";
  LaneGraph graph;
  graph.frame_id = "map";
  graph.lanes = {lane};
  const std::string written = path("written.json");
  write_lane_graph(written, graph);
  const LaneGraph read = read_lane_graph(written);
  EXPECT_EQ(read.frame_id, "map");
  ASSERT_EQ(read.lanes.size(), 1u);
  const GraphLane& same = read.lanes[0];
  EXPECT_EQ(same.centerline, lane.centerline);
  EXPECT_EQ(same.left_width[1].width, 1.6);
  EXPECT_EQ(same.successors, lane.successors);
  EXPECT_EQ(same.left_reverse, lane.left_reverse);
  EXPECT_EQ(same.left_paint[0].type, BoundaryType::kDoubleYellow);
  EXPECT_EQ(same.left_paint[1].s, 9.0);
  EXPECT_EQ(same.speed_limit, 8.333);
  EXPECT_EQ(same.type, LaneType::kBiking);
  EXPECT_EQ(same.turn, LaneTurn::kUTurn);
  EXPECT_EQ(same.road, "1272");
}

TEST_F(LaneGraphFile, WhatIsNotNamedIsNotKnown) {
  const LaneGraph graph =
      read_lane_graph(file(R"({"lanes": [{"id": "a", "centerline": [[0, 0], [1, 0]], "more": 1}]})"));
  EXPECT_TRUE(graph.lanes[0].left_width.empty());
  EXPECT_EQ(graph.lanes[0].speed_limit, 0.0);
  EXPECT_EQ(graph.lanes[0].type, LaneType::kCityDriving);
}

TEST_F(LaneGraphFile, AFaultNamesFileLaneAndKey) {
  EXPECT_THAT(graph_fault("{\"lanes\": [{"), HasSubstr("graph.json: not valid JSON near byte"));
  EXPECT_THAT(graph_fault("[]"), HasSubstr("must be a JSON object"));
  EXPECT_THAT(graph_fault("{}"), HasSubstr("lacks 'lanes'"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"centerline": []}]})"), HasSubstr("lane 0 lacks 'id'"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"id": "a"}]})"), HasSubstr("lane 'a' lacks 'centerline'"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"id": "a", "centerline": [[0, 0], [1]]}]})"),
              HasSubstr("lane 'a' 'centerline' must be a list of pairs"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"id": "a", "centerline": [[0, "x"]]}]})"),
              HasSubstr("must be a number"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"id": "a", "centerline": [], "left_paint": [[0, "pink"]]}]})"),
              HasSubstr("'pink' is not known"));
  EXPECT_THAT(graph_fault(R"({"lanes": [{"id": "a", "centerline": [], "successors": "b"}]})"),
              HasSubstr("'successors' must be a list"));
  EXPECT_THROW(read_lane_graph(path("nothing.json")), std::runtime_error);
}

TEST_F(LaneGraphFile, ARouteIsReadAsItWasWritten) {
  const std::string text =
      R"({"roads": [{"id": "r", "passages": [{"segments": [{"id": "a", "start_s": 5.5, "end_s": 60}], "can_exit": false,
       "change_lane_type": "LEFT"}, {"segments": [{"id": "b", "start_s": 0, "end_s": 50}], "can_exit": true}]}],
       "waypoints": [{"id": "a", "s": 5.5}, {"id": "b", "s": 50, "x": 1, "y": 2}], "distance": 44.5})";
  const Route route = read_route(file(text));
  ASSERT_EQ(route.roads.size(), 1u);
  EXPECT_EQ(route.roads[0].passages[0].change_lane, ChangeLane::kLeft);
  EXPECT_EQ(route.roads[0].passages[1].change_lane, ChangeLane::kForward);
  EXPECT_TRUE(route.roads[0].passages[1].can_exit);
  EXPECT_EQ(*route.waypoints[1].position, Point2(1.0, 2.0));
  const Route again = read_route(file(route_text(route)));
  EXPECT_TRUE(same_way(route, again));
  EXPECT_EQ(again.distance, 44.5);
}

TEST_F(LaneGraphFile, AFaultOfARouteNamesRoadAndPassage) {
  EXPECT_THAT(route_fault("{}"), HasSubstr("lacks 'roads'"));
  EXPECT_THAT(
      route_fault(
          R"({"roads": [{"passages": [{"segments": [{"id": "a", "start_s": 1}]}]}], "waypoints": []})"),
      HasSubstr("road 0, passage 0, segment 0 lacks 'end_s'"));
  EXPECT_THAT(
      route_fault(
          R"({"roads": [{"passages": [{"segments": [], "change_lane_type": "UP"}]}], "waypoints": []})"),
      HasSubstr("'UP' is no change_lane_type"));
  EXPECT_THAT(route_fault(R"({"roads": []})"), HasSubstr("lacks 'waypoints'"));
  EXPECT_THAT(route_fault(R"({"roads": [], "waypoints": [{"id": "a", "s": "x"}]})"),
              HasSubstr("waypoint 0 's' must be a number"));
}

}  // namespace
}  // namespace relative_map::core
