#include "relative_map/ros/messages/conversions.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "ros/messages.hpp"

namespace relative_map {
namespace {

using test::kNaN;
using test::Point2;
using test::Pose2;
using test::quaternion;
using test::set_xyz;
using test::yaw;

const ros::Time kReceived(200.0);

/// Where the vehicle stands and heads by such a message.
core::VehicleState state_of(const LocalizationEstimate& message,
                            OrientationConvention convention = OrientationConvention::kFlu) {
  const auto state = core::make_vehicle_state(to_core(message, convention, kReceived), std::nullopt);
  if (const auto* vehicle = std::get_if<core::VehicleState>(&state)) return *vehicle;
  ADD_FAILURE() << std::get<core::Status>(state).message;
  return {};
}

LocalizationEstimate without_heading(const Eigen::Quaterniond& map_from_body) {
  LocalizationEstimate message = test::localization(Pose2(), ros::Time(100.0));
  message.pose.heading = kNaN;
  message.pose.orientation = quaternion(map_from_body);
  return message;
}

TEST(Conversions, OrientationOfAnFluBodyIsItsHeading) {
  EXPECT_NEAR(state_of(without_heading(yaw(0.7))).map_from_base.heading(), 0.7, 1e-12);
}

TEST(Conversions, OrientationOfAnRfuBodyIsAQuarterTurnBehindItsHeading) {
  // Apollo: a car that drives north has orientation zero, and heading pi / 2.
  const auto north = state_of(without_heading(Eigen::Quaterniond::Identity()), OrientationConvention::kRfu);
  EXPECT_NEAR(north.map_from_base.heading(), core::kPi / 2.0, 1e-12);
  const auto east = state_of(without_heading(yaw(-core::kPi / 2.0)), OrientationConvention::kRfu);
  EXPECT_NEAR(east.map_from_base.heading(), 0.0, 1e-12);
}

TEST(Conversions, HeadingIsThatOfTheMessageInEitherConvention) {
  LocalizationEstimate message = without_heading(yaw(2.0));
  message.pose.heading = 0.3;
  for (const auto convention : {OrientationConvention::kFlu, OrientationConvention::kRfu}) {
    EXPECT_NEAR(state_of(message, convention).map_from_base.heading(), 0.3, 1e-12);
  }
}

TEST(Conversions, RollAndPitchOfAnRfuBodyAreTurnedWithIt) {
  // Heading east, nose up by 0.2: Apollo pitches about x, which points to the right.
  const Eigen::Quaterniond map_from_flu(Eigen::AngleAxisd(-0.2, Eigen::Vector3d::UnitY()));
  const Eigen::Quaterniond map_from_rfu =
      yaw(-core::kPi / 2.0) * Eigen::Quaterniond(Eigen::AngleAxisd(0.2, Eigen::Vector3d::UnitX()));
  const core::Localization converted =
      to_core(without_heading(map_from_rfu), OrientationConvention::kRfu, kReceived);
  EXPECT_TRUE(converted.map_from_body.isApprox(map_from_flu, 1e-12) ||
              converted.map_from_body.coeffs().isApprox(-map_from_flu.coeffs(), 1e-12));
}

TEST(Conversions, RatesOfAnRfuBodyAreTurnedToFlu) {
  LocalizationEstimate message = test::localization(Pose2(), ros::Time(100.0));
  set_xyz(message.pose.angular_velocity_vrf, {1.0, 2.0, 3.0});  // about right, forward, up
  const Eigen::Vector3d flu = to_core(message, OrientationConvention::kFlu, kReceived).angular_velocity_body;
  const Eigen::Vector3d rfu = to_core(message, OrientationConvention::kRfu, kReceived).angular_velocity_body;
  EXPECT_TRUE(flu.isApprox(Eigen::Vector3d(1.0, 2.0, 3.0), 1e-12)) << flu.transpose();
  EXPECT_TRUE(rfu.isApprox(Eigen::Vector3d(2.0, -1.0, 3.0), 1e-12)) << rfu.transpose();
}

TEST(Conversions, PositionAndVelocityAreTheMessages) {
  LocalizationEstimate message = test::localization(Pose2(Point2(442000.25, 4427000.5), 0.0), ros::Time(1.0));
  message.pose.position.z = 12.0;
  set_xyz(message.pose.linear_velocity, {3.0, 4.0, 5.0});
  const core::Localization converted = to_core(message, OrientationConvention::kFlu, kReceived);
  EXPECT_EQ(converted.position, Eigen::Vector3d(442000.25, 4427000.5, 12.0));
  EXPECT_EQ(converted.linear_velocity, Eigen::Vector3d(3.0, 4.0, 5.0));
}

TEST(Conversions, ReverseGearGivesTheSpeedItsSign) {
  const auto speed = [](uint8_t gear, double speed_mps) {
    Chassis message;
    message.gear_location = gear;
    message.speed_mps = speed_mps;
    return to_core(message, kReceived).speed;
  };
  EXPECT_EQ(speed(Chassis::GEAR_DRIVE, 5.0), 5.0);
  EXPECT_EQ(speed(Chassis::GEAR_REVERSE, 5.0), -5.0);
  EXPECT_EQ(speed(Chassis::GEAR_REVERSE, -5.0), -5.0);
  EXPECT_EQ(speed(Chassis::GEAR_NEUTRAL, -5.0), -5.0);
  EXPECT_EQ(speed(Chassis::GEAR_LOW, 5.0), 5.0);
  EXPECT_TRUE(std::isnan(speed(Chassis::GEAR_REVERSE, kNaN)));
}

TEST(Conversions, AStampIsExact) {
  const ros::Time stamp(1700000000, 123456789);
  EXPECT_EQ(to_ros(to_core(stamp)), stamp);
  EXPECT_EQ(to_core(stamp).time_since_epoch().count(), 1700000000123456789);
  EXPECT_TRUE(to_ros(core::Time(core::Duration(-1))).isZero());
}

TEST(Conversions, AStampThatWasNotFilledIsTheTimeOfReceipt) {
  const ros::Time zero, filled(100.0);
  const auto stamps = [](const ros::Time& stamp) {
    Chassis chassis;
    chassis.header.stamp = stamp;
    return std::vector<core::Time>{
        to_core(chassis, kReceived).stamp,
        to_core(test::localization(Pose2(), stamp), OrientationConvention::kFlu, kReceived).stamp,
        to_core(test::lane_markers(stamp), Pose2(), kReceived).stamp};
  };
  EXPECT_EQ(stamps(zero), std::vector<core::Time>(3, to_core(kReceived)));
  EXPECT_EQ(stamps(filled), std::vector<core::Time>(3, to_core(filled)));
}

TEST(Conversions, LaneMarkersKeepTheirSides) {
  LaneMarkers message = test::lane_markers(ros::Time(100.0));
  message.left_lane_marker.c1_heading_angle = 0.1;
  message.left_lane_marker.c2_curvature = 0.01;
  message.left_lane_marker.c3_curvature_derivative = 0.001;
  message.left_lane_marker.longitude_start = 3.0;
  message.left_lane_marker.quality = 0.75;
  message.next_left_lane_marker = {test::lane_marker(5.0), test::lane_marker(8.0)};
  message.next_right_lane_marker = {test::lane_marker(-5.0, LaneMarker::CURB)};
  const core::LaneMarkers markers = to_core(message, Pose2(Point2(1.5, 0.0), 0.1), kReceived);
  EXPECT_EQ(markers.left.cubic.c0, 1.75);
  EXPECT_EQ(markers.left.cubic.c1, 0.1);
  EXPECT_EQ(markers.left.cubic.c2, 0.01);
  EXPECT_EQ(markers.left.cubic.c3, 0.001);
  EXPECT_EQ(markers.left.longitude_start, 3.0);
  EXPECT_EQ(markers.left.view_range, 60.0);
  EXPECT_EQ(markers.left.quality, 0.75);
  EXPECT_EQ(markers.left.type, core::BoundaryType::kDottedWhite);
  EXPECT_EQ(markers.right.cubic.c0, -1.75);
  EXPECT_EQ(markers.right.type, core::BoundaryType::kSolidWhite);
  ASSERT_EQ(markers.next_left.size(), 2u);
  EXPECT_EQ(markers.next_left[1].cubic.c0, 8.0);
  ASSERT_EQ(markers.next_right.size(), 1u);
  EXPECT_EQ(markers.next_right[0].type, core::BoundaryType::kCurb);
  EXPECT_EQ(markers.base_from_sensor.position(), Point2(1.5, 0.0));
}

TEST(Conversions, PaintOfNoKnownTypeIsUnknown) {
  LaneMarkers message = test::lane_markers(ros::Time(100.0));
  message.left_lane_marker.lane_type = 7;
  message.right_lane_marker.lane_type = 255;
  const core::LaneMarkers markers = to_core(message, Pose2(), kReceived);
  EXPECT_EQ(markers.left.type, core::BoundaryType::kUnknown);
  EXPECT_EQ(markers.right.type, core::BoundaryType::kUnknown);
}

TEST(Conversions, FrameNamesLoseALeadingSlash) {
  EXPECT_EQ(frame_name("/map"), "map");
  EXPECT_EQ(frame_name("map"), "map");
  EXPECT_EQ(frame_name(""), "");
  NavigationInfo info;
  info.header.frame_id = "/map";
  EXPECT_EQ(to_core(info).frame_id, "map");
}

TEST(Conversions, NavigationLinesGoThereAndBack) {
  core::NavigationInfo info;
  info.frame_id = "map";
  info.lines = {
      {"first", 3, {{1.0, 2.0, 3.0, 0.4, 0.05, 0.006, 7.0}, {8.0, 9.0, 10.0, 0.1, 0.01, 0.001, 9.9}}},
      {"", 0, {}}};
  const core::NavigationInfo back = to_core(to_message(info));
  EXPECT_EQ(back.frame_id, "map");
  ASSERT_EQ(back.lines.size(), 2u);
  EXPECT_EQ(back.lines[0].name, "first");
  EXPECT_EQ(back.lines[0].priority, 3u);
  ASSERT_EQ(back.lines[0].points.size(), 2u);
  const core::LinePoint& point = back.lines[0].points[0];
  EXPECT_EQ((std::vector<double>{point.x, point.y, point.z, point.theta, point.kappa, point.dkappa, point.s}),
            (std::vector<double>{1.0, 2.0, 3.0, 0.4, 0.05, 0.006, 7.0}));
  EXPECT_TRUE(back.lines[1].points.empty());
}

TEST(Conversions, ReadWhatTheLocalizationSaysOfItself) {
  LocalizationEstimate message;
  const auto read = [&] { return to_core(message, OrientationConvention::kFlu, ros::Time(1.0)); };
  EXPECT_TRUE(std::isnan(read().position_stddev)) << "0 is: not given";
  EXPECT_TRUE(std::isnan(read().heading_stddev));
  EXPECT_FALSE(read().failure);
  message.uncertainty.position_std_dev.x = std::numeric_limits<double>::quiet_NaN();
  message.uncertainty.position_std_dev.y = 0.4;
  message.uncertainty.orientation_std_dev.z = 0.02;
  EXPECT_EQ(read().position_stddev, 0.4);
  EXPECT_EQ(read().heading_stddev, 0.02);
  message.status.code = LocalizationStatus::ERROR;
  message.status.message = "no fix";
  EXPECT_EQ(read().failure, std::string("no fix"));
  message.status.code = LocalizationStatus::WARNING;
  EXPECT_FALSE(read().failure);
}

TEST(Conversions, KnowTheSignOfASpeedByTheGear) {
  Chassis message;
  message.speed_mps = 3.0;
  for (const uint8_t gear : {Chassis::GEAR_DRIVE, Chassis::GEAR_LOW, Chassis::GEAR_REVERSE}) {
    message.gear_location = gear;
    EXPECT_TRUE(to_core(message, ros::Time(1.0)).sign_known);
  }
  for (const uint8_t gear : {Chassis::GEAR_NEUTRAL, Chassis::GEAR_NONE, Chassis::GEAR_INVALID}) {
    message.gear_location = gear;
    EXPECT_FALSE(to_core(message, ros::Time(1.0)).sign_known);
  }
}

}  // namespace
}  // namespace relative_map
