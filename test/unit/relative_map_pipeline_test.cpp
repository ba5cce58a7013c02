#include "relative_map/pipeline/relative_map_pipeline.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/scene.hpp"

// Maps from good inputs; those that fail are in pipeline_status_test.cpp.
namespace relative_map::core {
namespace {

using test::lane_about;
using test::lane_ids;
using test::recording;
using test::Scene;
using test::straight;
using test::three_straight_lines;

using Ids = std::vector<std::string>;

TEST(Pipeline, MapsThreeLinesLeftToRight) {
  Scene scene(three_straight_lines());
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.4), 0.0));
  EXPECT_EQ(map.status.code, StatusCode::kOk);
  EXPECT_EQ(lane_ids(map), Ids({"left", "middle", "right"}));
  EXPECT_EQ(map.current_lane_id, "middle");
  EXPECT_EQ(map.stamp, scene.now()) << "the pose's stamp";
  EXPECT_EQ(map.frame_id, "base_link");
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
  EXPECT_EQ(map.fusion.marker_age, -1.0);
  EXPECT_NEAR(map.fusion.left_half_width.value, 1.75, 1e-9);
  EXPECT_NEAR(map.fusion.right_half_width.value, 1.75, 1e-9);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(map.lanes[i].priority, i);
    EXPECT_NEAR(map.lanes[i].remaining_distance, 500.0, 1e-9);
    EXPECT_NEAR(map.lanes[i].length, 250.5, 0.51);
    EXPECT_NEAR(map.lanes[i].path.front().position.x(), -1.5, 0.26);
    for (const PathPoint& point : map.lanes[i].path) {
      EXPECT_NEAR(point.position.y(), 3.5 * (1.0 - static_cast<double>(i)) - 0.4, 1e-9);
    }
  }
}

TEST(Pipeline, WithoutMarkersTheLineComesOutAsItIs) {
  Scene scene({recording(test::arc(Pose2(Point2(7e5, 3e6), 1.0), 0.005, 400.0, 0.5))});
  const Pose2 pose = test::along_arc(Pose2(Point2(7e5, 3e6), 1.0), 0.005, 80.0);
  const RelativeMap map = scene.at(pose);
  std::size_t i = 157;
  for (const PathPoint& point : map.lanes[0].path) {
    const Point2 truth =
        test::along_arc(Pose2(Point2(7e5, 3e6), 1.0), 0.005, 0.5 * static_cast<double>(i++)).position();
    EXPECT_NEAR((point.position - pose.to_local(truth)).norm(), 0.0, 1e-8);
  }
}

TEST(Pipeline, CountsItsMaps) {
  Scene scene(three_straight_lines());
  const std::uint32_t first = scene.tick().sequence_num;  // empty
  EXPECT_EQ(scene.at(Pose2()).sequence_num, first + 1);
  EXPECT_EQ(scene.tick().sequence_num, first + 2);
}

TEST(Pipeline, LanesHaveTheSameIdsFromTickToTick) {
  Scene scene(three_straight_lines());
  for (double x = 0.0; x < 500.0; x += 7.0) {
    EXPECT_EQ(lane_ids(scene.at(Pose2(Point2(x, 1.0), 0.1))), Ids({"left", "middle", "right"}));
  }
}

TEST(Pipeline, ChangesTheCurrentLaneWithHysteresis) {
  Scene scene(three_straight_lines());
  EXPECT_EQ(scene.at(Pose2(Point2(100.0, 1.7), 0.0)).current_lane_id, "middle");
  EXPECT_EQ(scene.at(Pose2(Point2(101.0, 1.85), 0.0)).current_lane_id, "middle") << "only 0.2 m nearer";
  EXPECT_EQ(scene.at(Pose2(Point2(102.0, 1.95), 0.0)).current_lane_id, "left");
  EXPECT_EQ(scene.at(Pose2(Point2(103.0, 1.65), 0.0)).current_lane_id, "left") << "and only 0.2 m back";
  EXPECT_EQ(scene.at(Pose2(Point2(104.0, 1.55), 0.0)).current_lane_id, "middle");
}

TEST(Pipeline, ALaneThatBeginsAheadIsNotTheCurrentOneYet) {
  // The next line of the route starts 10 m ahead, dead ahead, where this one is half a metre aside.
  Scene scene({recording(straight(Pose2(), 100.0, 0.5), "this"),
               recording(straight(Pose2(Point2(60.0, -3.0), 0.0), 300.0, 0.5), "next", 1)});
  EXPECT_EQ(scene.at(Pose2(Point2(50.0, -2.0), 0.0)).current_lane_id, "this");
  EXPECT_EQ(scene.at(Pose2(Point2(61.0, -2.0), 0.0)).current_lane_id, "next");
}

TEST(Pipeline, OrdersALaneThatBeginsRoundABendByWhereItBegins) {
  // The road turns right by 90 degrees. Seen straight along its start, the right lane of the far leg would
  // pass left of the vehicle.
  const Pose2 start;
  Scene scene(
      {recording(test::arc(start, -1.0 / 12.0, 40.0, 0.4), "round"),
       recording(test::arc(test::along_arc(start, -1.0 / 12.0, 12.0).to_parent(Pose2(Point2(0.0, -3.0), 0.0)),
                           -1.0 / 9.0, 20.0, 0.3),
                 "inside", 1)});
  const RelativeMap map = scene.at(test::along_arc(start, -1.0 / 12.0, 1.0));
  EXPECT_EQ(lane_ids(map), Ids({"round", "inside"}));
  EXPECT_EQ(map.lanes[1].left_neighbor_id, "round");
}

TEST(Pipeline, ShiftsPrioritiesSoThatTheBestLeftHasZero) {
  Scene scene(three_straight_lines());
  const RelativeMap map = scene.at(Pose2(Point2(100.0, -12.0), 0.0));  // the left line is 15.5 m away
  EXPECT_EQ(lane_ids(map), Ids({"middle", "right"}));
  EXPECT_EQ(map.lanes[0].priority, 0u);
  EXPECT_EQ(map.lanes[1].priority, 1u);
  EXPECT_TRUE(scene.remarked("line 'left'"));
}

TEST(Pipeline, PublishesWhatIsLeftDownToTheLastMetre) {
  Scene scene({recording(straight(Pose2(), 100.0, 0.4))});
  for (double x = 70.0; x < 99.95; x += 0.3) {
    const RelativeMap map = scene.at(Pose2(Point2(x, 0.2), 0.0));
    ASSERT_EQ(map.status.code, StatusCode::kOk) << map.status.message << " at x = " << x;
    EXPECT_NEAR(map.lanes[0].remaining_distance, 100.0 - x, 1e-9);
    EXPECT_NEAR(map.lanes[0].path.back().position.x(), 100.0 - x, 1e-9);
  }
}

TEST(Pipeline, FusesTheCurrentLaneWithTheMarkers) {
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_marker_weight = 0.5;
  Scene scene(three_straight_lines(), config);
  LaneMarkers markers = lane_about({0.4}, 1.6);
  markers.right.type = BoundaryType::kSolidWhite;
  scene.see(markers);
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  EXPECT_EQ(map.fusion.source, Source::kFused);
  EXPECT_NEAR(map.fusion.lateral_offset.value, 0.2, 1e-9);
  EXPECT_NEAR(map.fusion.marker_range, 50.0, 1e-9);
  EXPECT_EQ(map.fusion.marker_age, 0.0);
  EXPECT_NEAR(map.lanes[1].path[20].position.y(), 0.2, 1e-9);
  EXPECT_NEAR(map.lanes[0].path[20].position.y(), 3.5, 1e-9) << "the others stay";
  EXPECT_EQ(map.lanes[1].right_boundary.paint.at(1).type, BoundaryType::kSolidWhite);
  EXPECT_EQ(map.lanes[2].left_boundary.paint.at(1).type, BoundaryType::kSolidWhite);
}

TEST(Pipeline, UsesMarkersWhereTheyWereSeen) {
  // The paint is 0.4 m left of the line, and the vehicle drives askew.
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_marker_weight = 1.0;
  Scene scene({recording(straight(Pose2(), 600.0, 0.5))}, config);
  const Pose2 seen_from(Point2(100.0, 0.0), 0.1),
      now(Point2(100.0 + 1.5 * std::cos(0.1), 1.5 * std::sin(0.1)), 0.1);
  const double slope = std::tan(-0.1);
  scene.see(lane_about({0.4 / std::cos(0.1), slope}, 1.75 / std::cos(0.1)));
  scene.at(seen_from, 15.0);
  const RelativeMap map = scene.at(now, 15.0);
  EXPECT_NEAR(map.fusion.marker_age, 0.1, 1e-9);
  std::size_t seen = 0;
  for (const PathPoint& point : map.lanes[0].path) {
    if (point.position.x() > 40.0) break;
    EXPECT_NEAR(now.to_parent(point.position).y(), 0.4, 1e-6) << "where the paint is on the road";
    ++seen;
  }
  EXPECT_GT(seen, 70u);
}

TEST(Pipeline, FollowsMarkersWhereNoLineIsInReach) {
  Scene scene({});
  scene.see(lane_about({0.3, 0.01}));
  const RelativeMap map = scene.at(Pose2(Point2(5.0, 6.0), 1.0));
  EXPECT_EQ(map.status.code, StatusCode::kOk);
  EXPECT_EQ(map.fusion.source, Source::kLaneMarkers);
  EXPECT_EQ(lane_ids(map), Ids({"lane_markers"}));
  EXPECT_EQ(map.roads.size(), 1u) << "with a road of its own";
  EXPECT_EQ(map.lanes[0].priority, 0u);
}

TEST(Pipeline, OnPerceptionTakesNoCountOfLines) {
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_source = LaneSource::kPerception;
  Scene scene(three_straight_lines(), config);
  scene.see(lane_about({0.3}));
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  EXPECT_EQ(lane_ids(map), Ids({"lane_markers"}));
  EXPECT_NEAR(map.lanes[0].path.front().position.x(), -2.0, 1e-12);
  EXPECT_NEAR(map.lanes[0].path.front().position.y(), 0.3, 1e-12);
}

/// Near the road and far from it, with priorities that are all above 0 and mostly used again.
std::vector<RecordedLine> ten_thousand_lines() {
  std::vector<RecordedLine> lines;
  for (int i = 0; i < 10000; ++i) {
    const double y = i % 10 == 0 ? 3.5 * (i / 10 % 8) - 12.0 : 50.0 * i;  // a tenth of them on eight lanes
    lines.push_back(recording(straight(Pose2(Point2(0.0, y), 0.0), 300.0, 3.0), "line " + std::to_string(i),
                              static_cast<std::uint32_t>(7 + i % 5)));
  }
  return lines;
}

TEST(Pipeline, PutsUpWithTenThousandLines) {
  Scene scene(ten_thousand_lines());
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.3), 0.0));
  ASSERT_EQ(map.status.code, StatusCode::kOk) << map.status.message;
  EXPECT_EQ(map.lanes.size(), 8u);
  std::size_t best = 0;
  for (const Lane& lane : map.lanes) best += lane.priority == 0 ? 1 : 0;
  EXPECT_EQ(best, 1u);
  EXPECT_LE(scene.pipeline().remarks().size(), 24u) << "a summary, not a sentence for each line";
  EXPECT_TRUE(scene.remarked("more lines are out of reach"));
  EXPECT_TRUE(scene.remarked("lines are in reach: only the best 16 are used"));
}

TEST(Pipeline, MergesLinesThatAreTheSameAndSaysSo) {
  std::vector<RecordedLine> lines = three_straight_lines();
  lines.push_back(lines[1]);
  lines.back().name = "again";
  lines.back().priority = 7;
  Scene scene(lines);
  EXPECT_EQ(lane_ids(scene.at(Pose2(Point2(100.0, 0.0), 0.0))), Ids({"left", "middle", "right"}));
  EXPECT_TRUE(scene.remarked("'again' is left out"));
}

TEST(Pipeline, KeepsLanesApartThatTheMarkersPushTogether) {
  // The paint shows the lane 2.5 m to the left, where the left line is 1 m farther on.
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_marker_weight = 1.0;
  Scene scene(three_straight_lines(), config);
  scene.see(lane_about({2.5}));
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  EXPECT_EQ(map.current_lane_id, "middle");
  EXPECT_EQ(lane_ids(map), Ids({"middle", "right"})) << "the lane that is seen stays";
  EXPECT_TRUE(scene.remarked("'left' is left out"));
}

TEST(Pipeline, DoesWithoutMarkersThatAreAnotherLanes) {
  // Just across the line between two lanes: the camera sees the new lane, the current one is the old one yet.
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_marker_weight = 1.0;
  Scene scene(three_straight_lines(), config);
  scene.at(Pose2(Point2(99.0, 1.6), 0.0));
  scene.see(lane_about({1.65}));
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 1.85), 0.0));
  EXPECT_EQ(map.current_lane_id, "middle");
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
  EXPECT_EQ(map.fusion.marker_age, -1.0);
  EXPECT_NEAR(map.lanes[1].path[20].position.y(), -1.85, 1e-9);
  EXPECT_EQ(map.lanes[1].left_boundary.paint.size(), 1u) << "and no paint is put where it is not";
  EXPECT_TRUE(scene.remarked("lane markers: they are another lane's: line 'middle' is 3.5 m from them"));
}

TEST(Pipeline, DrivesRoundALapForEver) {
  Scene scene({recording(test::circle(190.0 / (2.0 * kPi), 380))});
  const Pose2 start(Point2(190.0 / (2.0 * kPi), 0.0), kPi / 2.0);
  for (double driven = 0.0; driven < 400.0; driven += 1.0) {
    const RelativeMap map = scene.at(test::along_arc(start, 2.0 * kPi / 190.0, driven));
    ASSERT_EQ(map.status.code, StatusCode::kOk);
    EXPECT_GT(map.lanes[0].length, 250.0);
    EXPECT_NEAR(map.lanes[0].remaining_distance, 190.0, 0.1);
  }
}

TEST(Pipeline, CrossesTheSeamOfALapSmoothly) {
  // The lap drifts outwards by 1.2 m: what a recording by GPS may close with. Three laps of it.
  const double radius = 190.0 / (2.0 * kPi), error = 1.2;
  Polyline lap;
  for (int i = 0; i < 380; ++i) {
    const double t = i / 380.0;
    lap.push_back((radius + error * t) * Point2(std::cos(2.0 * kPi * t), std::sin(2.0 * kPi * t)));
  }
  Scene scene({recording(lap)});
  const Pose2 start(Point2(radius, 0.0), kPi / 2.0);
  double steepest = 0.0;
  for (double driven = 0.0; driven < 3.0 * 190.0; driven += 1.3) {
    const RelativeMap map = scene.at(test::along_arc(start, 1.0 / radius, driven));
    ASSERT_EQ(map.status.code, StatusCode::kOk) << "after " << driven << " m: " << map.status.message;
    const PathPoints& path = map.lanes[0].path;
    EXPECT_GT(path.back().s, 250.0);
    for (std::size_t i = 1; i < path.size(); ++i) {
      EXPECT_GT(path[i].s - path[i - 1].s, 0.2) << "no point is doubled";
      EXPECT_LT(path[i].s - path[i - 1].s, 0.8) << "no point is missing";
      EXPECT_NEAR(path[i].kappa, 1.0 / radius, 0.025) << "after " << driven << " m, at s = " << path[i].s;
      EXPECT_LT(std::abs(angle_difference(path[i].theta, path[i - 1].theta)), 0.035);
      steepest = std::max(steepest, std::abs(path[i].kappa - path[i - 1].kappa));
    }
  }
  EXPECT_LT(steepest, 0.003);
}

TEST(Pipeline, TakesNewLinesFromOneTickToTheNext) {
  Scene scene(three_straight_lines());
  scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  scene.set_lines({recording(straight(Pose2(Point2(0.0, 1.0), 0.0), 600.0, 0.5), "new")});
  EXPECT_EQ(lane_ids(scene.at(Pose2(Point2(101.0, 0.0), 0.0))), Ids({"new"}));
}

TEST(Pipeline, TakesANewConfigFromOneTickToTheNext) {
  Scene scene(three_straight_lines());
  scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  auto config = std::make_shared<PipelineConfig>();
  config->navigation_lane.max_len_from_navigation_line = 50.0;
  scene.pipeline().set_config(config);
  EXPECT_NEAR(scene.at(Pose2(Point2(101.0, 0.0), 0.0)).lanes[0].length, 50.5, 0.51);
}

}  // namespace
}  // namespace relative_map::core
