// A map as a message, and read back from it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "ros/engine.hpp"

namespace relative_map {
namespace {

using test::Engine;
using test::Point2;
using test::Pose2;
using test::shared;
using testing::IsEmpty;

/// The map of a fused drive, as the pipeline built it and as it was sent.
struct BuiltAndSent {
  core::RelativeMap built;
  MapMsg sent;
};

BuiltAndSent map_on_three_lanes(const core::PipelineConfig& config = core::PipelineConfig()) {
  const Pose2 start(Point2(1000.0, 2000.0), 0.6);
  NodeConfig node;
  node.pipeline = config;
  Engine engine(node);
  engine.set_lines(test::three_lanes(start));
  const ros::Time stamp(100, 5);
  engine.drive_to(start.to_parent(Pose2(Point2(20.0, 0.2), 0.01)), stamp);
  engine->on_lane_markers(shared(test::lane_markers(stamp)), stamp);
  const MapMsg sent = engine.map_at(stamp);
  return {engine->last_map(), sent};
}

void expect_same(const std::vector<core::WidthSample>& a, const std::vector<core::WidthSample>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].s, b[i].s);
    EXPECT_EQ(a[i].width, b[i].width);
  }
}

void expect_same(const core::LaneBoundary& a, const core::LaneBoundary& b) {
  EXPECT_EQ(a.points, b.points);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.is_virtual, b.is_virtual);
  ASSERT_EQ(a.paint.size(), b.paint.size());
  for (std::size_t i = 0; i < a.paint.size(); ++i) {
    EXPECT_EQ(a.paint[i].s, b.paint[i].s);
    EXPECT_EQ(a.paint[i].type, b.paint[i].type);
  }
}

void expect_same(const core::PathPoints& a, const core::PathPoints& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].position, b[i].position);
    EXPECT_EQ(a[i].theta, b[i].theta);
    EXPECT_EQ(a[i].kappa, b[i].kappa);
    EXPECT_EQ(a[i].dkappa, b[i].dkappa);
    EXPECT_EQ(a[i].s, b[i].s);
  }
}

void expect_same(const core::Lane& a, const core::Lane& b) {
  SCOPED_TRACE(a.id);
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.name, b.name);
  EXPECT_EQ(a.priority, b.priority);
  EXPECT_EQ(a.length, b.length);
  EXPECT_EQ(a.remaining_distance, b.remaining_distance);
  EXPECT_EQ(a.speed_limit, b.speed_limit);
  EXPECT_EQ(a.left_neighbor_id, b.left_neighbor_id);
  EXPECT_EQ(a.right_neighbor_id, b.right_neighbor_id);
  expect_same(a.path, b.path);
  expect_same(a.left_boundary, b.left_boundary);
  expect_same(a.right_boundary, b.right_boundary);
  expect_same(a.left_samples, b.left_samples);
  expect_same(a.right_samples, b.right_samples);
  expect_same(a.left_road_samples, b.left_road_samples);
  expect_same(a.right_road_samples, b.right_road_samples);
}

TEST(MapMessage, AMapReadBackIsTheMapThatWasBuilt) {
  core::PipelineConfig config;
  config.generate_left_boundary = false;
  config.lane_fusion.method = "fixed_weight";
  config.navigation_lane.lane_marker_weight = 0.5;
  const auto [built, sent] = map_on_three_lanes(config);
  const core::RelativeMap back = to_core(sent);
  ASSERT_EQ(built.lanes.size(), 3u);
  ASSERT_TRUE(built.lanes[0].left_boundary.is_virtual);
  ASSERT_EQ(built.fusion.source, core::Source::kFused);
  EXPECT_EQ(back.stamp, built.stamp);
  EXPECT_EQ(back.frame_id, built.frame_id);
  EXPECT_EQ(back.sequence_num, built.sequence_num);
  EXPECT_EQ(back.status.code, built.status.code);
  EXPECT_EQ(back.status.message, built.status.message);
  EXPECT_EQ(back.current_lane_id, built.current_lane_id);
  ASSERT_EQ(back.lanes.size(), built.lanes.size());
  for (std::size_t i = 0; i < built.lanes.size(); ++i) expect_same(built.lanes[i], back.lanes[i]);
  ASSERT_EQ(back.roads.size(), 1u);
  EXPECT_EQ(back.roads[0].id, built.roads[0].id);
  EXPECT_EQ(back.roads[0].lane_ids, built.roads[0].lane_ids);
  EXPECT_EQ(back.roads[0].left_edge, built.roads[0].left_edge);
  EXPECT_EQ(back.roads[0].right_edge, built.roads[0].right_edge);
}

TEST(MapMessage, AFusionStateReadBackIsTheSame) {
  core::RelativeMap map;
  map.fusion.source = core::Source::kLaneMarkers;
  map.fusion.method = "fixed_weight";
  double next = 0.0;
  for (core::Estimate* estimate :
       {&map.fusion.lateral_offset, &map.fusion.longitudinal_offset, &map.fusion.heading_offset,
        &map.fusion.left_half_width, &map.fusion.right_half_width}) {
    estimate->value = next += 1.0;
    estimate->stddev = next += 1.0;
  }
  map.fusion.marker_range = 40.0;
  map.fusion.marker_age = 0.1;
  const core::FusionState back = to_core(*to_message(map)).fusion;
  EXPECT_EQ(back.source, core::Source::kLaneMarkers);
  EXPECT_EQ(back.method, "fixed_weight");
  next = 0.0;
  for (const core::Estimate* estimate :
       {&back.lateral_offset, &back.longitudinal_offset, &back.heading_offset, &back.left_half_width,
        &back.right_half_width}) {
    EXPECT_EQ(estimate->value, next += 1.0);
    EXPECT_EQ(estimate->stddev, next += 1.0);
  }
  EXPECT_EQ(back.marker_range, 40.0);
  EXPECT_EQ(back.marker_age, 0.1);
}

TEST(MapMessage, AMapReadBackKeepsTheContract) {
  for (const core::Violation& violation : core::check_map(to_core(map_on_three_lanes().sent), {})) {
    ADD_FAILURE() << violation.row << ": " << violation.what;
  }
}

TEST(MapMessage, AMapSaysEverythingInApollosTerms) {
  core::PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  const auto [built, sent] = map_on_three_lanes(config);
  EXPECT_EQ(sent.header.stamp, ros::Time(100, 5));
  EXPECT_EQ(sent.header.frame_id, "base_link");
  ASSERT_EQ(sent.hdmap.lane.size(), 3u);
  for (const Lane& lane : sent.hdmap.lane) {
    EXPECT_EQ(lane.type, Lane::CITY_DRIVING);
    EXPECT_EQ(lane.turn, Lane::NO_TURN);
    EXPECT_EQ(lane.direction, Lane::FORWARD);
    EXPECT_TRUE(lane.left_neighbor_reverse_lane_id.empty());
    EXPECT_TRUE(lane.predecessor_id.empty());
    ASSERT_EQ(lane.central_curve.segment.size(), 1u);
    const CurveSegment& segment = lane.central_curve.segment[0];
    EXPECT_EQ(segment.length, lane.length);
    EXPECT_EQ(segment.start_position, segment.line_segment.point.front());
    EXPECT_NEAR(segment.heading, -0.01, 1e-3);
    EXPECT_NEAR(lane.left_boundary.curve.segment[0].heading, -0.01, 1e-3);
  }
  ASSERT_EQ(sent.hdmap.road.size(), 1u);
  ASSERT_EQ(sent.hdmap.road[0].section.size(), 1u);
  const auto& edges = sent.hdmap.road[0].section[0].boundary.outer_polygon.edge;
  ASSERT_EQ(edges.size(), 2u);
  EXPECT_EQ(edges[0].type, BoundaryEdge::LEFT_BOUNDARY);
  EXPECT_EQ(edges[1].type, BoundaryEdge::RIGHT_BOUNDARY);
}

TEST(MapMessage, AnEmptyMapIsAMessageWithoutLanes) {
  core::RelativeMap map;
  map.stamp = core::at_seconds(100.0);
  map.frame_id = "base_link";
  map.status = {core::StatusCode::kOffRoute, "far away"};
  const MapMsgPtr message = to_message(map);
  EXPECT_EQ(message->status.code, MapStatus::OFF_ROUTE);
  EXPECT_EQ(message->status.message, "far away");
  EXPECT_THAT(message->hdmap.lane, IsEmpty());
  EXPECT_THAT(message->hdmap.road, IsEmpty());
  EXPECT_THAT(message->navigation_path, IsEmpty());
  EXPECT_EQ(message->fusion.marker_age, -1.0);
  EXPECT_THAT(core::check_map(to_core(*message), {}), IsEmpty());
}

TEST(MapMessage, ADefaultMessageIsReadWithoutFault) {
  EXPECT_NO_THROW(to_core(MapMsg()));
  MapMsg scraps;
  scraps.hdmap.lane.resize(1);
  scraps.hdmap.road.resize(1);
  scraps.navigation_path.resize(2);
  scraps.navigation_path[1].lane_id = "nobody";
  EXPECT_NO_THROW(to_core(scraps));
  EXPECT_FALSE(core::check_map(to_core(scraps), {}).empty());
}

TEST(MapMessage, TellsWhereTheVehicleIsAlongEachLane) {
  const BuiltAndSent map = map_on_three_lanes();
  ASSERT_EQ(map.sent.navigation_path.size(), 3u);
  for (const LaneNavigationPath& lane : map.sent.navigation_path) {
    const std::vector<PathPoint>& points = lane.navigation_path.path.path_point;
    ASSERT_GT(lane.vehicle_s, 0.0);
    ASSERT_LT(lane.vehicle_s, points.back().s);
    const auto after = std::find_if(points.begin(), points.end(),
                                    [&](const PathPoint& point) { return point.s > lane.vehicle_s; });
    const auto before = after - 1;
    const double t = (lane.vehicle_s - before->s) / (after->s - before->s);
    EXPECT_NEAR(before->x + t * (after->x - before->x), 0.0, 0.06) << "beside the vehicle";
  }
}

TEST(MapMessage, HasTheSpeedLimitOfEachLine) {
  NodeConfig config;
  config.speed_limits = {{"left", 16.7}, {"right", 8.3}, {"nowhere", 1.0}};
  config.pipeline.map_param.default_speed_limit = 20.0;
  Engine engine(config);
  engine.set_lines(test::three_lanes(Pose2()));
  engine.drive_to(Pose2(Point2(20.0, 0.0), 0.0), ros::Time(10.0));
  const MapMsg map = engine.map_at(ros::Time(10.0));
  ASSERT_EQ(map.hdmap.lane.size(), 3u);
  EXPECT_EQ(map.hdmap.lane[0].speed_limit, 16.7);
  EXPECT_EQ(map.hdmap.lane[1].speed_limit, 20.0);
  EXPECT_EQ(map.hdmap.lane[2].speed_limit, 8.3);
}

TEST(MapMessage, FillsTheSecondDerivativeOfTheCurvature) {
  const BuiltAndSent map = map_on_three_lanes();
  for (const LaneNavigationPath& lane : map.sent.navigation_path) {
    const std::vector<PathPoint>& points = lane.navigation_path.path.path_point;
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      const double rate = (points[i + 1].dkappa - points[i - 1].dkappa) / (points[i + 1].s - points[i - 1].s);
      ASSERT_DOUBLE_EQ(points[i].ddkappa, rate);
    }
    EXPECT_TRUE(std::isfinite(points.front().ddkappa) && std::isfinite(points.back().ddkappa));
  }
}

}  // namespace
}  // namespace relative_map
