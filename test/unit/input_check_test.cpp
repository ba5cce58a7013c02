#include "relative_map/pipeline/input_check.hpp"

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

TEST(LocalizationCheck, TakesAnInfiniteHeadingAsNotGiven) {
  const auto checked = check_localization(facing(std::numeric_limits<double>::infinity(), 1.0));
  EXPECT_TRUE(std::isnan(checked.input.heading));
  EXPECT_FALSE(checked.refusal);
}

TEST(LocalizationCheck, TakesAZeroOrientationAsNotGiven) {
  Localization localization = facing(1.0, 0.0);
  localization.map_from_body.coeffs().setZero();
  EXPECT_THAT(check_localization(localization).remarks, IsEmpty());
}

TEST(LocalizationCheck, TakesAVelocityOfExactlyZeroAsNotGiven) {
  Localization localization = facing(1.0, 1.0);
  localization.linear_velocity.setZero();
  EXPECT_TRUE(check_localization(localization).input.linear_velocity.array().isNaN().all()) << "poses tell";
  localization.linear_velocity.x() = 1e-9;
  EXPECT_EQ(check_localization(localization).input.linear_velocity, localization.linear_velocity);
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
  EXPECT_THAT(checked.remarks, ElementsAre(HasSubstr("pose.orientation is the identity")));
}

TEST(LocalizationCheck, RefusesTwoDirectionsThatContradictEachOther) {
  const auto checked = check_localization(facing(0.5, 1.2));
  ASSERT_TRUE(checked.refusal);
  EXPECT_EQ(checked.refusal->code, StatusCode::kInvalidLocalization);
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
  EXPECT_THAT(checked.remarks, ElementsAre("lane markers: right_lane_marker.quality is inf: not used"));
  EXPECT_THAT(spoilt(&LaneMarker::view_range, -kInfinity).remarks,
              ElementsAre("lane markers: right_lane_marker.view_range is -inf: not used"));
  EXPECT_THAT(spoilt(&LaneMarker::longitude_start, test::kNaN).remarks,
              ElementsAre("lane markers: right_lane_marker.longitude_start is nan: not used"));
  LaneMarkers markers = test::lane_about({0.2});
  markers.left.cubic.c2 = test::kNaN;
  EXPECT_THAT(check_lane_markers(markers).remarks,
              ElementsAre("lane markers: left_lane_marker.c2_curvature is nan: not used"));
  EXPECT_THAT(check_lane_markers(test::lane_about({0.2})).remarks, IsEmpty());
}

TEST(ChassisCheck, LeavesReverseAlone) {
  Chassis chassis;
  chassis.speed = -3.0;
  EXPECT_EQ(check_chassis(chassis).input.speed, -3.0);
  EXPECT_THAT(check_chassis(chassis).remarks, IsEmpty());
}

}  // namespace
}  // namespace relative_map::core
