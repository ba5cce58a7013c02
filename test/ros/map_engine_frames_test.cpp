// Links and map frames: the map is that of base_link, whatever was localized.
#include <gmock/gmock.h>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "ros/moving_vehicle.hpp"

namespace relative_map {
namespace {

using test::base_from_imu;
using test::Engine;
using test::expect_same_lanes;
using test::kNaN;
using test::kStamp;
using test::localization_of_link;
using test::Point2;
using test::Pose2;
using test::quaternion;
using test::shared;
using test::yaw;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

class MapEngineFrames : public test::MovingVehicleTest {};

TEST_F(MapEngineFrames, AnEmptyChildFrameIsTheBodyFrame) {
  const LocalizationEstimate plain = localization_of_link(drive, Eigen::Isometry3d::Identity(), "");
  const MapMsg map = map_of(plain);
  Engine other;
  other.set_lines(test::three_lanes(drive.pose.to_parent(Pose2(Point2(-20.0, 0.4), 0.02))));
  other->on_localization(shared(localization_of_link(drive, Eigen::Isometry3d::Identity(), "base_link")),
                         kStamp);
  expect_same_lanes(map, other.map_at(kStamp), 3, 1e-9);
}

TEST_F(MapEngineFrames, AnotherLinksPoseGivesTheSameMap) {
  const MapMsg expected = map_of_base_link();
  engine.mount("base_link", "imu_link", base_from_imu());
  for (const char* name : {"imu_link", "/imu_link"}) {
    engine->reset();
    const MapMsg map = map_of(localization_of_link(drive, base_from_imu(), name));
    expect_same_lanes(map, expected, 3, 1e-8);  // what UTM coordinates leave of a double
    EXPECT_EQ(map.header.frame_id, "base_link");
    EXPECT_EQ(map.localization.child_frame_id, name);
  }
}

TEST_F(MapEngineFrames, TransformsMayGoOverSeveralLinks) {
  const MapMsg expected = map_of_base_link();
  engine->reset();
  Eigen::Isometry3d base_from_rack = Eigen::Isometry3d::Identity();
  base_from_rack.translate(Eigen::Vector3d(0.5, 0.1, 1.5));
  base_from_rack.rotate(yaw(1.0));
  engine.mount("base_link", "rack", base_from_rack);
  engine.mount("rack", "imu_link", base_from_rack.inverse() * base_from_imu());
  expect_same_lanes(map_of(localization_of_link(drive, base_from_imu(), "imu_link")), expected, 3, 1e-8);
}

TEST_F(MapEngineFrames, AMissingTransformOfTheLocalizedLinkIsNamed) {
  for (int i = 0; i < 3; ++i) {
    LocalizationEstimate message = localization_of_link(drive, base_from_imu(), "imu_link");
    message.header.stamp += ros::Duration(0.1 * i);
    const MapMsg map = map_of(message);
    EXPECT_EQ(map.status.code, MapStatus::NO_TRANSFORM);
    EXPECT_THAT(map.status.message, AllOf(HasSubstr("'imu_link'"), HasSubstr("'base_link'")));
    EXPECT_THAT(map.hdmap.lane, IsEmpty());
    EXPECT_EQ(map.header.stamp, message.header.stamp);
  }
}

TEST_F(MapEngineFrames, ATransformThatComesLateIsUsed) {
  map_of(localization_of_link(drive, base_from_imu(), "imu_link"));
  engine.mount("base_link", "imu_link", base_from_imu());
  LocalizationEstimate message = localization_of_link(drive, base_from_imu(), "imu_link");
  message.header.stamp += ros::Duration(0.1);
  EXPECT_EQ(map_of(message).status.code, MapStatus::OK);
}

TEST_F(MapEngineFrames, ALinkThatLosesItsTransformEmptiesTheMapAtOnce) {
  ASSERT_EQ(map_of_base_link().status.code, MapStatus::OK);
  LocalizationEstimate message = localization_of_link(drive, base_from_imu(), "imu_link");
  message.header.stamp += ros::Duration(0.1);
  const MapMsg map = map_of(message);
  EXPECT_EQ(map.status.code, MapStatus::NO_TRANSFORM);
  EXPECT_GE(map.header.stamp, message.header.stamp);
}

TEST_F(MapEngineFrames, NavigationInAnotherMapFrameIsNamed) {
  LocalizationEstimate message = localization_of_link(drive, Eigen::Isometry3d::Identity(), "base_link");
  message.header.frame_id = "odom";
  const MapMsg map = map_of(message);
  EXPECT_EQ(map.status.code, MapStatus::FRAME_MISMATCH);
  EXPECT_THAT(map.status.message, AllOf(HasSubstr("'map'"), HasSubstr("'odom'")));
  EXPECT_THAT(map.hdmap.lane, IsEmpty());
  EXPECT_THAT(core::check_map(to_core(map), {}), IsEmpty());
}

TEST_F(MapEngineFrames, NavigationWithoutAFrameIsNamed) {
  NavigationInfo lines = test::three_lanes(drive.pose);
  lines.header.frame_id.clear();
  engine.set_lines(lines);
  const MapMsg map = map_of_base_link();
  EXPECT_EQ(map.status.code, MapStatus::FRAME_MISMATCH);
  EXPECT_THAT(map.status.message, HasSubstr("navigation is in frame ''"));
}

TEST_F(MapEngineFrames, OfNavigationWithoutLinesTheFrameDoesNotMatter) {
  engine.set_lines(NavigationInfo());
  EXPECT_EQ(map_of_base_link().status.code, MapStatus::NO_NAVIGATION_LINE);
}

TEST(MapEnginePerception, TakesNoCountOfTheFrameOfLines) {
  NodeConfig config;
  config.pipeline.navigation_lane.lane_source = core::LaneSource::kPerception;
  Engine engine(config);
  NavigationInfo lines = test::three_lanes(Pose2());
  lines.header.frame_id = "another_map";
  engine.set_lines(lines);
  engine->on_lane_markers(shared(test::lane_markers(kStamp)), kStamp);
  engine.drive_to(Pose2(), kStamp);
  const MapMsg map = engine.map_at(kStamp);
  EXPECT_EQ(map.status.code, MapStatus::OK) << map.status.message;
  EXPECT_EQ(map.fusion.source, FusionState::LANE_MARKERS);
}

TEST_F(MapEngineFrames, ALeadingSlashMakesNoOtherMapFrame) {
  LocalizationEstimate message = localization_of_link(drive, Eigen::Isometry3d::Identity(), "base_link");
  message.header.frame_id = "/map";
  EXPECT_EQ(map_of(message).status.code, MapStatus::OK);
}

TEST(MapEngineBaseFrame, IsTheMapsFrame) {
  NodeConfig config;
  config.pipeline.base_frame = "rear_axle";
  Engine engine(config);
  engine.set_lines(test::three_lanes(Pose2()));
  engine.drive_to(Pose2(Point2(20.0, 0.0), 0.0), kStamp);
  const MapMsg map = engine.map_at(kStamp);
  EXPECT_EQ(map.status.code, MapStatus::OK);
  EXPECT_EQ(map.header.frame_id, "rear_axle");
}

TEST(MapEngineOrientation, OfAnRfuLocalizationIsTurned) {
  NodeConfig config;
  config.orientation_convention = OrientationConvention::kRfu;
  Engine engine(config);
  engine.set_lines(test::three_lanes(Pose2(Point2(0.0, 0.0), 0.6)));
  LocalizationEstimate message =
      test::localization(Pose2(Point2(20.0 * std::cos(0.6), 20.0 * std::sin(0.6)), 0.6), kStamp);
  message.pose.heading = kNaN;
  message.pose.orientation = quaternion(yaw(0.6 - core::kPi / 2.0));
  engine->on_localization(shared(message), kStamp);
  const MapMsg map = engine.map_at(kStamp);
  ASSERT_EQ(map.navigation_path.size(), 3u) << map.status.message;
  EXPECT_NEAR(map.navigation_path[1].navigation_path.path.path_point[0].theta, 0.0, 1e-9);
  EXPECT_NEAR(map.localization.pose.heading, 0.6, 1e-9) << "which was not given";
}

}  // namespace
}  // namespace relative_map
