#include <gmock/gmock.h>

#include "relative_map/pipeline/lines/current_lane.hpp"
#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "support/scene.hpp"

// What the pipeline keeps from message to message, for how long, and what it forgets.
namespace relative_map::core {
namespace {

using test::lane_about;
using test::localization_at;
using test::Scene;
using testing::Contains;
using testing::HasSubstr;

const Pose2 kOnTheRoad(Point2(100.0, 0.0), 0.0);

PipelineConfig markers_alone() {
  PipelineConfig config;
  config.navigation_lane.lane_source = LaneSource::kPerception;
  return config;
}

TEST(PipelineMemory, IsForgottenByAReset) {
  Scene scene({}, markers_alone());
  scene.see(lane_about({0.0}));
  EXPECT_EQ(scene.at(kOnTheRoad).status.code, StatusCode::kOk);
  scene.see(lane_about({0.0}));  // on its way when the reset comes
  scene.pipeline().reset();
  const RelativeMap map = scene.at(kOnTheRoad);
  EXPECT_EQ(map.status.code, StatusCode::kMarkersUnusable);
  EXPECT_THAT(map.status.message, HasSubstr("lane markers: none received yet"));
}

/// [m] of the lane that markers make, which is as long as the speed asks for.
double length_with(const std::optional<Chassis>& chassis, bool reset = false) {
  Scene scene({}, markers_alone());
  if (chassis) {
    Chassis relative = *chassis;
    relative.stamp += (scene.now() + scene.step).time_since_epoch();
    scene.pipeline().set_chassis(relative);
  }
  if (reset) scene.pipeline().reset();
  scene.wait(to_seconds(scene.step));
  LaneMarkers markers = lane_about({0.0});
  markers.stamp = scene.now();
  scene.pipeline().set_localization(localization_at(kOnTheRoad, scene.now(), 20.0));
  scene.pipeline().set_lane_markers(markers);
  const RelativeMap map = scene.tick();
  return map.lanes.empty() ? 0.0 : map.lanes[0].length;
}

TEST(PipelineMemory, AChassisCountsWhileItIsOfNow) {
  const auto chassis = [](double age) { return Chassis{at_seconds(-age), 30.0}; };
  EXPECT_NEAR(length_with(std::nullopt), 162.0, 2.0) << "20 m/s of localization";
  EXPECT_NEAR(length_with(chassis(0.0)), 242.0, 2.0) << "30 m/s of the chassis";
  EXPECT_NEAR(length_with(chassis(0.9)), 242.0, 2.0);
  EXPECT_NEAR(length_with(chassis(1.1)), 162.0, 2.0) << "too old";
  EXPECT_NEAR(length_with(chassis(-1.1)), 162.0, 2.0) << "of the future";
  EXPECT_NEAR(length_with(chassis(0.0), true), 162.0, 2.0) << "forgotten";
}

TEST(PipelineMemory, ABadInputIsToldThoughAGoodOneReplacedIt) {
  Scene scene(test::three_straight_lines());
  scene.at(kOnTheRoad);
  const Time between = scene.now() + from_seconds(0.01);
  scene.pipeline().set_chassis({between, 1000.0});
  Localization localization = localization_at(kOnTheRoad, between);
  localization.position.x() = std::numeric_limits<double>::quiet_NaN();
  scene.pipeline().set_localization(localization);
  LaneMarkers markers = lane_about({0.0});
  markers.left.view_range = -5.0;
  markers.stamp = between;
  scene.pipeline().set_lane_markers(markers);
  scene.see(lane_about({0.0}));
  EXPECT_EQ(scene.at(kOnTheRoad).status.code, StatusCode::kOk);
  for (const char* words :
       {"speed_mps is 1000", "pose.position.x is nan", "left_lane_marker.view_range is -5"}) {
    EXPECT_THAT(scene.pipeline().remarks(), Contains(HasSubstr(words)));
  }
  scene.at(kOnTheRoad);
  for (const char* words : {"speed_mps", "pose.position.x", "view_range"})
    EXPECT_FALSE(scene.remarked(words)) << words;
}

TEST(PipelineMemory, ARemarkOnMarkersEndsWithThem) {
  Scene scene(test::three_straight_lines());
  LaneMarkers markers = lane_about({0.0});
  markers.left.view_range = -5.0;
  scene.see(markers);
  scene.at(kOnTheRoad);
  EXPECT_TRUE(scene.remarked("view_range is -5"));
  for (int i = 0; i < 7; ++i) scene.at(kOnTheRoad);
  EXPECT_FALSE(scene.remarked("view_range is -5"));
}

TEST(PipelineMemory, LocalizationOfTheFutureIsNone) {
  Scene scene(test::three_straight_lines());
  scene.pipeline().set_localization(localization_at(kOnTheRoad, scene.now() + from_seconds(0.6)));
  const RelativeMap map = scene.tick();
  EXPECT_EQ(map.status.code, StatusCode::kInvalidLocalization);
  EXPECT_THAT(map.status.message, HasSubstr("header.stamp is 0.6 s in the future"));
}

TEST(PipelineMemory, HalfWidthsAreThoseBesideTheVehicle) {
  // Two lines that part: 3 m from each other at first, 4 m after 200 m.
  const auto line = [](double side, const char* name, std::uint32_t priority) {
    Polyline points;
    for (double x = 0.0; x <= 200.0; x += 1.0) points.emplace_back(x, side * (1.5 + 0.5 * x / 200.0));
    return test::recording(points, name, priority);
  };
  PipelineConfig config;
  config.navigation_lane.max_len_from_navigation_line = 250.0;
  Scene scene({line(1.0, "left", 1), line(-1.0, "right", 0)}, config);
  const RelativeMap map = scene.at(Pose2(Point2(150.0, -1.875), 0.0));
  EXPECT_EQ(map.current_lane_id, "right");
  EXPECT_NEAR(map.fusion.left_half_width.value, 1.875, 0.005);
}

TEST(ExpectedHalfWidth, TakesNoLineThatLiesTooNear) {
  NavigationLine line;
  const auto at = [&](double l) {
    TrackedLine tracked{&line, {}};
    tracked.projection.l = l;
    return tracked;
  };
  const NavigationLaneParam param;
  const auto expected = [&](double l) { return expected_half_width({at(0.0), at(l)}, at(0.0), param, 1.75); };
  EXPECT_EQ(expected(3.4), 1.7);
  EXPECT_EQ(expected(-3.8), 1.9);
  EXPECT_EQ(expected(1.0), 1.75) << "as of a copy, or of a line that joins";
  EXPECT_EQ(expected(4.2), 1.75) << "no neighbour";
}

}  // namespace
}  // namespace relative_map::core
