#include "relative_map/pipeline/estimation/marker_lane_estimator.hpp"

#include <gtest/gtest.h>

#include "support/scene.hpp"

namespace relative_map::core {
namespace {

using test::lane_about;
using test::Scene;

PipelineConfig markers_alone() {
  PipelineConfig config;
  config.navigation_lane.lane_source = LaneSource::kPerception;
  return config;
}

/// The cubic of a circle's arc through the vehicle, to the third order, `offset` [m] to its left.
Cubic arc_ahead(double kappa, double offset = 0.0) {
  return {offset, 0.0, kappa / (2.0 * (1.0 - kappa * offset)), 0.0};
}

const PathPoint& at(const RelativeMap& map, double x) {
  for (const PathPoint& point : map.lanes.at(0).path) {
    if (point.position.x() >= x) return point;
  }
  throw std::out_of_range("the lane ends before");
}

TEST(MarkerLane, TheFirstImageIsBelievedAsItIs) {
  Scene scene({}, markers_alone());
  scene.see(lane_about({0.3, 0.02, 1e-3, -1e-6}));
  const RelativeMap map = scene.at(Pose2());
  ASSERT_EQ(map.status.code, StatusCode::kOk) << map.status.message;
  EXPECT_EQ(map.fusion.source, Source::kLaneMarkers);
  EXPECT_EQ(map.fusion.method, "estimator");
  for (const double x : {0.0, 10.0, 30.0, 48.0}) {
    EXPECT_NEAR(at(map, x).position.y(), 0.3 + x * (0.02 + x * (1e-3 - x * 1e-6)), 0.05) << x;
  }
}

TEST(MarkerLane, IsCarriedOnByOdometryForAStatedTime) {
  PipelineConfig config = markers_alone();
  config.lane_fusion.hold_time = 2.0;
  Scene scene({}, config);
  const double kappa = 0.01;
  Pose2 pose;
  const auto drive_on = [&](bool seen) {
    if (seen) scene.see(lane_about(arc_ahead(kappa)));
    pose = test::along_arc(pose, kappa, 1.0);
    return scene.at(pose, 10.0, 10.0 * kappa);
  };
  for (int i = 0; i < 20; ++i) drive_on(true);
  RelativeMap map;
  for (int i = 0; i < 19; ++i) {
    map = drive_on(false);
    ASSERT_EQ(map.status.code, StatusCode::kOk) << i;
    EXPECT_NEAR(at(map, 0.0).position.y(), 0.0, 0.15) << i;
  }
  EXPECT_NEAR(map.fusion.marker_age, 1.9, 1e-9);
  EXPECT_NEAR(map.fusion.marker_range, 50.0 - 19.0, 1.5);
  for (int i = 0; i < 3; ++i) map = drive_on(false);
  EXPECT_EQ(map.status.code, StatusCode::kMarkersUnusable);
  EXPECT_TRUE(map.lanes.empty());
}

TEST(MarkerLane, StaysWhereItIsWhileTheVehicleTurnsAway) {
  Scene scene({}, markers_alone());
  Pose2 pose;  // the lane is the x axis
  for (int i = 0; i < 15; ++i) {
    pose = test::along_arc(pose, 0.01, 1.0);
    const double aside = -pose.position().y() / std::cos(pose.heading());
    if (i < 8) scene.see(lane_about({aside, -std::tan(pose.heading())}));
    EXPECT_NEAR(at(scene.at(pose, 10.0, 0.1), 0.0).position.y(), aside, 0.01) << i;
  }
}

TEST(MarkerLane, PastWhatWasSeenTheCurvatureFadesToZero) {
  Scene scene({}, markers_alone());
  RelativeMap map;
  for (int i = 0; i < 10; ++i) {
    scene.see(lane_about(arc_ahead(0.01), 1.75, 30.0));
    map = scene.at(test::along_arc(Pose2(), 0.01, i), 10.0, 0.1);
  }
  EXPECT_NEAR(map.lanes.at(0).path.at(10).kappa, 0.01, 1e-3);
  EXPECT_NEAR(map.lanes.at(0).path.back().kappa, 0.0, 1e-9);
}

TEST(MarkerLane, OneSideIsEnoughOnceTheWidthIsKnown) {
  Scene scene({}, markers_alone());
  RelativeMap map;
  for (int i = 0; i < 60; ++i) {
    LaneMarkers markers = lane_about({0.2}, 1.6);
    if (i > 20) markers.left.quality = 0.0;
    scene.see(markers);
    map = scene.at(Pose2(Point2(i, 0.0), 0.0), 10.0);
  }
  EXPECT_NEAR(at(map, 10.0).position.y(), 0.2, 0.03);
  EXPECT_NEAR(map.fusion.left_half_width.value, 1.6, 0.03);
}

TEST(MarkerLane, PaintThatGoesOnElsewhereIsAnotherLanes) {
  Scene scene({}, markers_alone());
  RelativeMap map;
  for (int i = 0; i < 40; ++i) {
    scene.see(lane_about({i < 20 ? -1.7 : 1.8}));
    map = scene.at(Pose2(Point2(i, 0.0), 0.0), 10.0);
    ASSERT_EQ(map.status.code, StatusCode::kOk) << i;
  }
  EXPECT_NEAR(at(map, 10.0).position.y(), 1.8, 0.05);
}

TEST(MarkerLane, AnOutlierIsLeftOut) {
  for (const double jump : {-3.5, -1.5, 1.5, 3.5}) {
    Scene scene({}, markers_alone());
    for (int i = 0; i < 30; ++i) {
      LaneMarkers markers = lane_about({0.2});
      if (i > 20) markers.right.cubic.c0 += jump;
      scene.see(markers);
      const RelativeMap map = scene.at(Pose2(Point2(i, 0.0), 0.0), 10.0);
      ASSERT_EQ(map.status.code, StatusCode::kOk);
      EXPECT_NEAR(at(map, 10.0).position.y(), 0.2, 0.03) << jump;
    }
    EXPECT_TRUE(scene.remarked("is ignored")) << jump;
  }
}

TEST(MarkerLane, DoesNotStartFromPaintWithNoLaneBetween) {
  for (const double half_width : {0.0, 0.5, 4.5}) {
    Scene scene({}, markers_alone());
    scene.see(lane_about({0.2}, half_width));
    EXPECT_EQ(scene.at(Pose2()).status.code, StatusCode::kMarkersUnusable) << half_width;
    EXPECT_TRUE(scene.remarked("both are ignored: no lane is between them"));
    scene.see(lane_about({0.2}));
    EXPECT_EQ(scene.at(Pose2(Point2(1.0, 0.0), 0.0)).status.code, StatusCode::kOk);
  }
}

}  // namespace
}  // namespace relative_map::core
