#include <gtest/gtest.h>

#include "support/scene.hpp"

// Inputs that broke the contract once, found by ugly drives with hundreds of thousands of seeds. (The scene
// holds each map against the contract.)
namespace relative_map::core {
namespace {

using test::recording;
using test::Scene;

/// On nothing but one image of `markers`, then on odometry, then on a camera that is well.
void drive_on_markers(const LaneMarkers& markers, PipelineConfig config = PipelineConfig()) {
  config.navigation_lane.lane_source = LaneSource::kPerception;
  Scene scene({}, config);
  for (int i = 0; i < 12; ++i) {
    if (i == 0) scene.see(markers);
    if (i > 6) scene.see(test::lane_about({0.3}));
    const RelativeMap map = scene.at(Pose2(Point2(i, 0.0), 0.0));
    ASSERT_FALSE(testing::Test::HasFailure()) << "step " << i;
    if (i > 9) {
      EXPECT_EQ(map.status.code, StatusCode::kOk) << map.status.message;
    }
  }
}

/// The same with the left marker alone, with the right one alone, and with both.
void drive_on_each(const LaneMarker& left) {
  LaneMarkers markers = test::lane_about({0.3});
  markers.left = left;
  drive_on_markers(markers);
  markers.right = LaneMarker();
  drive_on_markers(markers);
  markers.right = left;
  markers.right.cubic.c0 -= 3.5;
  drive_on_markers(markers);
  markers.left = LaneMarker();
  drive_on_markers(markers);
}

TEST(StubbornInputs, ThereAndBackAgainIsNoLap) {
  // Its ends meet. Without what lies over its start, one point and the way back to it are left.
  const Polyline line = {{0.0, 0.0}, {0.0, 105.9}, {0.0, 0.0}, {-10.25, 25.0}, {-11.34, 26.4}, {-0.41, 1.41}};
  Scene scene({recording(line)});
  for (const double y : {10.0, 50.0, 90.0}) {
    scene.at(Pose2(Point2(0.3, y), 0.5 * kPi));
    scene.at(Pose2(Point2(0.3, y), -0.5 * kPi));
  }
}

TEST(StubbornInputs, PaintFromFarBehindTellsNoLaneAhead) {
  for (const double start : {-1e3, -1e6, -1e9, -1e30}) {
    for (const double range : {2.5, 50.0}) {
      LaneMarker marker = test::marker({2.05}, range);
      marker.longitude_start = start;
      drive_on_each(marker);
    }
  }
}

TEST(StubbornInputs, PaintAsFarAsNoCameraSeesTellsNoMoreThanOtherPaint) {
  for (const double range : {1e3, 1e6, 1e9, 1e30}) drive_on_each(test::marker({2.05}, range));
}

TEST(StubbornInputs, AQualityOfMoreThanAllIsNone) {
  for (const double quality : {40.0, 90.0, 1e30, 1e308}) {
    drive_on_each(test::marker({2.05}, 50.0, quality));
  }
  PipelineConfig config;
  config.navigation_lane.min_lane_marker_quality = 0.0;
  for (const double quality : {1e-9, 1e-160, 1e-300}) {
    LaneMarkers markers = test::lane_about({0.3});
    markers.left.quality = markers.right.quality = quality;
    drive_on_markers(markers, config);
  }
}

}  // namespace
}  // namespace relative_map::core
