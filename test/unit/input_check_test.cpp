#include "relative_map/pipeline/motion/input_check.hpp"

#include <gmock/gmock.h>

#include "support/lines.hpp"
#include "support/markers.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Localization facing(double heading, double yaw) {
  Localization localization;
  localization.heading = heading;
  localization.map_from_body = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ());
  return localization;
}

TEST(LocalizationCheck, LeavesAGoodOneAlone) {
  const auto checked = check_localization(facing(1.0, 1.05));
  EXPECT_FALSE(checked.refusal);
  EXPECT_THAT(checked.remarks, IsEmpty());
  EXPECT_EQ(checked.input.heading, 1.0);
}

TEST(LocalizationCheck, ComparesDirectionsTheShortWayRound) {
  EXPECT_THAT(check_localization(facing(kPi - 0.01, -kPi + 0.01)).remarks, IsEmpty());
}

TEST(LocalizationCheck, TakesAHeadingThatIsNoAngleAsNotGivenAndSaysSo) {
  for (const double heading : {std::numeric_limits<double>::infinity(), -1e9}) {
    const auto checked = check_localization(facing(heading, 1.0));
    EXPECT_TRUE(std::isnan(checked.input.heading));
    EXPECT_FALSE(checked.refusal);
    EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr(heading > 0.0 ? "pose.heading is inf rad"
                                                                     : "pose.heading is -1e+09 rad")));
  }
  EXPECT_THAT(check_localization(facing(kNaN, 1.0)).remarks, IsEmpty()) << "NaN is: not given";
}

TEST(LocalizationCheck, DoesWithoutAnOrientationThatGivesNoDirectionAndSaysSo) {
  Localization localization = facing(1.0, 0.0);
  localization.map_from_body.coeffs().setZero();
  EXPECT_THAT(check_localization(localization).remarks,
              ElementsAre(HasSubstr("pose.orientation (x, y, z, w) is (0, 0, 0, 0)")));
  localization.map_from_body.coeffs() << 0.0, 0.0, kNaN, 1.0;
  const auto checked = check_localization(localization);
  EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("is (0, 0, nan, 1)")));
  EXPECT_TRUE(checked.input.map_from_body.coeffs().isZero());
  EXPECT_EQ(checked.input.heading, 1.0);
}

TEST(LocalizationCheck, TakesAVelocityOfExactlyZeroForAValue) {
  Localization localization = facing(1.0, 1.0);
  localization.linear_velocity.setZero();
  EXPECT_EQ(check_localization(localization).input.linear_velocity, localization.linear_velocity);
}

TEST(LocalizationCheck, RefusesAHeadingThatIsNoAngleInRadians) {
  for (const double heading : {90.0, -7.0, 359.0}) {
    auto checked = check_localization(facing(heading, 1.0));
    EXPECT_FALSE(checked.refusal) << "the orientation tells";
    EXPECT_TRUE(std::isnan(checked.input.heading));
    EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("is it in degrees?")));
    Localization alone = facing(heading, 0.0);
    alone.map_from_body.coeffs().setZero();
    checked = check_localization(alone);
    ASSERT_TRUE(checked.refusal);
    EXPECT_EQ(checked.refusal->code, StatusCode::kInvalidLocalization);
    EXPECT_THAT(checked.refusal->message, HasSubstr("is it in degrees?"));
  }
  EXPECT_FALSE(check_localization(facing(2.0 * kPi, 0.001)).refusal) << "a full turn is an angle";
}

TEST(LocalizationCheck, RefusesWhatTheLocalizationItselfCallsAFailure) {
  Localization localization = facing(1.0, 1.0);
  localization.failure = "no fix";
  const auto checked = check_localization(localization);
  ASSERT_TRUE(checked.refusal);
  EXPECT_EQ(checked.refusal->code, StatusCode::kInvalidLocalization);
  EXPECT_THAT(checked.refusal->message, HasSubstr("status ERROR): no fix"));
}

TEST(LocalizationCheck, NormalisesAndSaysSo) {
  Localization localization = facing(1.0, 1.0);
  localization.map_from_body.coeffs() *= 3.0;
  const auto checked = check_localization(localization);
  EXPECT_NEAR(checked.input.map_from_body.norm(), 1.0, 1e-12);
  EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("pose.orientation has norm 3")));
}

TEST(LocalizationCheck, NamesTheOtherConventionAtNinetyDegrees) {
  const auto checked = check_localization(facing(1.0, 1.0 - kPi / 2.0));
  EXPECT_FALSE(checked.refusal);
  EXPECT_EQ(checked.input.heading, 1.0);
  EXPECT_THAT(checked.remarks, ElementsAre(testing::AllOf(HasSubstr("90 degrees"),
                                                          HasSubstr("orientation_convention is wrong"))));
}

TEST(LocalizationCheck, TakesTheOrientationOverAHeadingThatWasNeverFilled) {
  const auto checked = check_localization(facing(0.0, 2.5));
  EXPECT_TRUE(std::isnan(checked.input.heading));
  EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("pose.heading is 0")));
}

TEST(LocalizationCheck, TakesTheHeadingOverAnOrientationThatWasNeverFilled) {
  const auto checked = check_localization(facing(2.5, 0.0));
  EXPECT_EQ(checked.input.heading, 2.5);
  EXPECT_THAT(checked.remarks, ElementsAre(testing::AllOf(HasSubstr("pose.heading (2.5 rad)"),
                                                          HasSubstr("pose.orientation is the identity"))));
}

TEST(LocalizationCheck, RefusesTwoDirectionsThatContradictEachOther) {
  const auto checked = check_localization(facing(0.5, 1.2));
  ASSERT_TRUE(checked.refusal);
  EXPECT_EQ(checked.refusal->code, StatusCode::kInvalidLocalization);
  EXPECT_THAT(checked.refusal->message, HasSubstr("pose.heading (0.5 rad)"));
  EXPECT_THAT(checked.refusal->message, HasSubstr("disagree by -40.1"));
}

TEST(LocalizationCheck, IgnoresMotionThatNoCarMakes) {
  Localization localization = facing(1.0, 1.0);
  localization.linear_velocity = {1000.0, 0.0, 0.0};
  localization.angular_velocity_body = {0.0, 0.0, 40.0};
  const auto checked = check_localization(localization);
  EXPECT_TRUE(std::isnan(checked.input.linear_velocity.x()));
  EXPECT_TRUE(std::isnan(checked.input.angular_velocity_body.z()));
  EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("pose.linear_velocity is 1000 m/s"),
                                           HasSubstr("pose.angular_velocity_vrf.z is 40 rad/s")));
}

TEST(LocalizationCheck, IgnoresMotionThatIsNoNumber) {
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    Localization localization = facing(1.0, 1.0);
    localization.linear_velocity.y() = localization.angular_velocity_body.z() = bad;
    const auto checked = check_localization(localization);
    EXPECT_TRUE(std::isnan(checked.input.linear_velocity.x()));
    EXPECT_TRUE(std::isnan(checked.input.angular_velocity_body.z()));
    EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("pose.linear_velocity is"),
                                             HasSubstr("pose.angular_velocity_vrf.z is")));
  }
}

TEST(ChassisCheck, IgnoresASpeedThatNoCarDrives) {
  Chassis chassis;
  chassis.speed = 1000.0;
  const auto checked = check_chassis(chassis);
  EXPECT_TRUE(std::isnan(checked.input.speed));
  EXPECT_THAT(checked.remarks, ElementsAre("chassis: speed_mps is 1000: ignored"));
}

TEST(LaneMarkerCheck, DoesWithoutAMarkerThatHasANumberWhichIsNotFinite) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto spoilt = [](double LaneMarker::*field, double value) {
    LaneMarkers markers = test::lane_about({0.2});
    markers.right.*field = value;
    return check_lane_markers(markers);
  };
  const auto checked = spoilt(&LaneMarker::quality, kInfinity);
  EXPECT_EQ(checked.input.right.quality, 0.0);
  EXPECT_EQ(checked.input.left.quality, 0.9) << "the other one stays";
  EXPECT_THAT(checked.remarks,
              ElementsAre("perception/lane_markers: right_lane_marker.quality is inf: not used"));
  EXPECT_THAT(spoilt(&LaneMarker::view_range, -kInfinity).remarks,
              ElementsAre("perception/lane_markers: right_lane_marker.view_range is -inf: not used"));
  EXPECT_THAT(spoilt(&LaneMarker::longitude_start, test::kNaN).remarks,
              ElementsAre("perception/lane_markers: right_lane_marker.longitude_start is nan: not used"));
  LaneMarkers markers = test::lane_about({0.2});
  markers.left.cubic.c2 = test::kNaN;
  EXPECT_THAT(check_lane_markers(markers).remarks,
              ElementsAre("perception/lane_markers: left_lane_marker.c2_curvature is nan: not used"));
  EXPECT_THAT(check_lane_markers(test::lane_about({0.2})).remarks, IsEmpty());
}

TEST(LaneMarkerCheck, DoesWithoutAMarkerThatNoCameraReports) {
  const auto told = [](auto change) {
    LaneMarkers markers = test::lane_about({0.2});
    change(markers.left);
    const auto checked = check_lane_markers(markers);
    EXPECT_EQ(checked.input.left.quality, 0.0);
    EXPECT_EQ(checked.input.right.quality, 0.9) << "the other one stays";
    return checked.remarks.size() == 1 ? checked.remarks[0] : "not one remark";
  };
  const std::string name = "perception/lane_markers: left_lane_marker.";
  EXPECT_EQ(told([](LaneMarker& left) { left.view_range = -5.0; }), name + "view_range is -5: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.quality = 90.0; }), name + "quality is 90: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.quality = -1.0; }), name + "quality is -1: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.cubic.c0 = 20.0; }), name + "c0_position is 20: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.cubic.c1 = -6.0; }), name + "c1_heading_angle is -6: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.cubic.c2 = 1.0; }), name + "c2_curvature is 1: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.cubic.c3 = 1e3; }),
            name + "c3_curvature_derivative is 1000: not used");
  EXPECT_EQ(told([](LaneMarker& left) { left.longitude_start = 1e9; }),
            name + "longitude_start is 1e+09: not used");
}

TEST(LaneMarkerCheck, TakesAReachThatNoCameraHasAsTheFarthestThatOneHas) {
  LaneMarkers markers = test::lane_about({0.2}, 1.75, 1e9);
  markers.left.longitude_start = -1e9;
  const auto checked = check_lane_markers(markers);
  EXPECT_EQ(checked.input.left.view_range, 300.0);
  EXPECT_EQ(checked.input.left.longitude_start, -50.0);
  EXPECT_EQ(checked.input.left.quality, 0.9);
  EXPECT_THAT(checked.remarks,
              ElementsAre(HasSubstr("left_lane_marker.view_range is 1e+09 m: taken as 300 m"),
                          HasSubstr("left_lane_marker.longitude_start is -1e+09 m: taken as -50 m"),
                          HasSubstr("right_lane_marker.view_range is 1e+09 m: taken as 300 m")));
}

TEST(LaneMarkerCheck, TakesAQualityThatWasRoundedUpAsOne) {
  LaneMarkers markers = test::lane_about({0.2});
  markers.left.quality = 1.0000001;
  const auto checked = check_lane_markers(markers);
  EXPECT_EQ(checked.input.left.quality, 1.0);
  EXPECT_THAT(checked.remarks, IsEmpty());
}

TEST(LaneMarkerCheck, AsksNothingOfAMarkerThatIsNotSeen) {
  LaneMarkers markers = test::lane_about({0.2});
  markers.left.quality = 0.0;
  markers.left.cubic.c0 = markers.left.view_range = kNaN;
  EXPECT_THAT(check_lane_markers(markers).remarks, IsEmpty());
}

TEST(LaneMarkerCheck, LooksAtTheMarkersBeyondToo) {
  LaneMarkers markers = test::lane_about({0.2});
  markers.next_left = {test::marker({5.25}), test::marker({12.0})};
  markers.next_right = {test::marker({-5.25, kNaN})};
  const auto checked = check_lane_markers(markers);
  EXPECT_THAT(checked.remarks, ElementsAre("perception/lane_markers: next_right_lane_marker.c1_heading_angle "
                                           "is nan: not used"));
  EXPECT_EQ(checked.input.next_right[0].quality, 0.0);
  EXPECT_EQ(checked.input.next_left[1].quality, 0.9);
}

TEST(LaneMarkerCheck, NamesTheWidthOfALaneThatIsNone) {
  const auto told = [](double half_width) {
    return check_lane_markers(test::lane_about({0.25}, half_width)).remarks;
  };
  EXPECT_THAT(told(0.0),
              ElementsAre("perception/lane_markers: c0_position of left_lane_marker is 0.25 m and of "
                          "right_lane_marker 0.25 m, a lane of 0 m: each is used only where it is expected"));
  EXPECT_THAT(told(6.0), ElementsAre(HasSubstr("a lane of 12 m")));
  for (const double half_width : {0.55, 1.75, 4.9}) EXPECT_THAT(told(half_width), IsEmpty());
  EXPECT_THAT(told(-1.75), IsEmpty()) << "mirrored: told elsewhere";
}

TEST(ChassisCheck, LeavesReverseAlone) {
  Chassis chassis;
  chassis.speed = -3.0;
  EXPECT_EQ(check_chassis(chassis).input.speed, -3.0);
  EXPECT_THAT(check_chassis(chassis).remarks, IsEmpty());
}

}  // namespace
}  // namespace relative_map::core
