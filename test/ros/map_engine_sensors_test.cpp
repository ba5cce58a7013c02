// Lane markers: from where they are mounted, and from where they were seen.
#include <gmock/gmock.h>

#include "ros/moving_vehicle.hpp"

namespace relative_map {
namespace {

using test::base_from_imu;
using test::expect_same_lanes;
using test::kStamp;
using test::localization_of_link;
using test::Point2;
using test::Pose2;
using test::shared;
using test::yaw;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Fused without a memory, so that maps of one moment can be compared to the last digit.
NodeConfig fixed_weight() {
  NodeConfig config;
  config.pipeline.lane_fusion.method = "fixed_weight";
  return config;
}

class MapEngineSensors : public test::MovingVehicleTest {
 protected:
  MapEngineSensors() : MovingVehicleTest(fixed_weight()) {}
};

/// Speed and yaw rate show in where markers are carried to that are newer than the pose.
class MapEngineVelocities : public test::MovingVehicleTest {
 protected:
  MapEngineVelocities() : MovingVehicleTest(markers_alone()) {}

  static NodeConfig markers_alone() {
    NodeConfig config = fixed_weight();
    config.pipeline.navigation_lane.lane_source = core::LaneSource::kPerception;
    return config;
  }

  /// The map from markers that were seen 0.2 s after the pose.
  MapMsg carried(const Eigen::Isometry3d& base_from_link, const std::string& link) {
    engine->reset();
    const ros::Time seen = kStamp + ros::Duration(0.2);
    engine->on_localization(shared(localization_of_link(drive, base_from_link, link)), kStamp);
    engine->on_lane_markers(shared(test::lane_markers(seen)), seen);
    return engine.map_at(seen);
  }
};

TEST_F(MapEngineVelocities, AreThoseOfBaseLink) {
  const MapMsg map = carried(Eigen::Isometry3d::Identity(), "base_link");
  ASSERT_EQ(map.navigation_path.size(), 1u) << map.status.message;
  // 8 m/s and 0.3 rad/s over 0.2 s: an arc of 1.6 m that turns by 0.06 rad; from its end on straight ahead.
  const double turn = 0.06, radius = 8.0 / 0.3;
  const PathPoint& point = map.navigation_path[0].navigation_path.path.path_point[3];
  EXPECT_NEAR(point.theta, turn, 1e-9);
  const double left = radius * (1.0 - std::cos(turn)), ahead = radius * std::sin(turn);
  EXPECT_NEAR((point.y - left) * std::cos(turn) - (point.x - ahead) * std::sin(turn), 0.0, 1e-6);
  EXPECT_NEAR(map.fusion.marker_range, ahead + 60.0, 1e-6);
}

TEST_F(MapEngineVelocities, OfAnotherLinkAreCarriedWithTheirLeverArm) {
  const MapMsg expected = carried(Eigen::Isometry3d::Identity(), "base_link");
  engine.mount("base_link", "imu_link", base_from_imu());
  expect_same_lanes(carried(base_from_imu(), "imu_link"), expected, 1, 1e-7);
}

TEST_F(MapEngineSensors, MarkersOfACameraGiveTheSameMapAsThoseOfBaseLink) {
  // A lane beside the line that runs as the line does, so that it does not matter from where on it is seen.
  const Pose2 base_from_lane(Point2(0.0, 0.3), 0.02);
  const auto fused = [&](const Pose2& base_from_sensor, const std::string& frame) {
    const Pose2 lane = base_from_sensor.to_local(base_from_lane);
    const double slope = std::tan(lane.heading());
    const double half_width = 1.75 / std::cos(lane.heading());
    LaneMarkers markers = test::lane_markers(kStamp, 0.0, frame);
    for (LaneMarker* marker : {&markers.left_lane_marker, &markers.right_lane_marker}) {
      const double side = marker == &markers.left_lane_marker ? 1.0 : -1.0;
      marker->c0_position = lane.position().y() - slope * lane.position().x() + side * half_width;
      marker->c1_heading_angle = slope;
    }
    engine->reset();
    engine->on_lane_markers(shared(markers), kStamp);
    return map_of_base_link();
  };
  const MapMsg expected = fused(Pose2(), "base_link");

  Eigen::Isometry3d mount = Eigen::Isometry3d::Identity();
  mount.translate(Eigen::Vector3d(1.8, 0.2, 1.3));
  mount.rotate(yaw(0.1));
  engine.mount("base_link", "camera_link", mount);
  const MapMsg map = fused(Pose2(Point2(1.8, 0.2), 0.1), "camera_link");

  ASSERT_EQ(map.fusion.source, FusionState::FUSED) << map.status.message;
  ASSERT_EQ(expected.fusion.source, FusionState::FUSED) << expected.status.message;
  EXPECT_LT(expected.fusion.lateral_offset, -0.01);
  EXPECT_NEAR(map.fusion.lateral_offset, expected.fusion.lateral_offset, 1e-6);
  EXPECT_NEAR(map.fusion.heading_offset, expected.fusion.heading_offset, 1e-6);
  // Up to 30 m: the view range is counted from the sensor.
  const auto& path = map.navigation_path[1].navigation_path.path.path_point;
  const auto& other = expected.navigation_path[1].navigation_path.path.path_point;
  for (std::size_t i = 0; path[i].x < 30.0; ++i) {
    EXPECT_NEAR(path[i].x, other[i].x, 1e-6) << i;
    EXPECT_NEAR(path[i].y, other[i].y, 1e-6) << i;
  }
}

TEST_F(MapEngineSensors, MarkersWithoutTransformAreDroppedByName) {
  engine->on_lane_markers(shared(test::lane_markers(kStamp, 0.0, "camera_link")), kStamp);
  const MapMsg map = map_of_base_link();
  EXPECT_EQ(map.status.code, MapStatus::OK);
  EXPECT_EQ(map.fusion.source, FusionState::NAVIGATION_LINE);
  EXPECT_THAT(map.status.message,
              AllOf(HasSubstr("lane markers"), HasSubstr("'camera_link'"), HasSubstr("'base_link'")));
}

TEST_F(MapEngineSensors, MarkersWithoutTransformDoNotHideWhatElseIsWrong) {
  NavigationInfo lines = test::three_lanes(drive.pose);
  lines.navigation_path.push_back(
      test::navigation_path(core::test::straight(Pose2(Point2(0.0, 0.0), 0.0), 90.0, 1.0), "far_away", 9));
  engine.set_lines(lines);
  engine->on_lane_markers(shared(test::lane_markers(kStamp, 0.0, "camera_link")), kStamp);
  EXPECT_THAT(map_of_base_link().status.message, AllOf(HasSubstr("'camera_link'"), HasSubstr("far_away")));
}

TEST_F(MapEngineVelocities, MarkersWithoutTransformAreNamedWhereTheyAreAllThereIs) {
  engine->on_lane_markers(shared(test::lane_markers(kStamp, 0.0, "camera_link")), kStamp);
  const MapMsg map = map_of_base_link();
  EXPECT_EQ(map.status.code, MapStatus::MARKERS_UNUSABLE);
  EXPECT_THAT(map.status.message, HasSubstr("'camera_link'"));
}

TEST_F(MapEngineSensors, MarkersThatComeBackInAKnownFrameAreUsedAgain) {
  engine->on_lane_markers(shared(test::lane_markers(kStamp, 0.0, "camera_link")), kStamp);
  engine->on_lane_markers(shared(test::lane_markers(kStamp, 0.0, "/base_link")), kStamp);
  const MapMsg map = map_of_base_link();
  EXPECT_EQ(map.fusion.source, FusionState::FUSED);
  EXPECT_THAT(map.status.message, Not(HasSubstr("camera_link")));
}

}  // namespace
}  // namespace relative_map
