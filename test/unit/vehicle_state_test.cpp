#include "relative_map/pipeline/motion/vehicle_state.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using test::vehicle_at;
using testing::HasSubstr;

Eigen::Quaterniond yaw(double angle) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
}

Localization localization_at(const Pose2& pose, double speed = 10.0) {
  Localization localization;
  localization.stamp = at_seconds(1.0);
  localization.position << pose.position(), 3.0;
  localization.heading = pose.heading();
  localization.map_from_body = yaw(pose.heading());
  localization.linear_velocity << speed * pose.forward(), 0.0;
  return localization;
}

VehicleState state_of(const Localization& localization,
                      const std::optional<Chassis>& chassis = std::nullopt) {
  const auto state = make_vehicle_state(localization, chassis);
  if (const auto* status = std::get_if<Status>(&state)) {
    ADD_FAILURE() << status->message;
    return {};
  }
  return std::get<VehicleState>(state);
}

std::string refusal_of(const Localization& localization) {
  const auto state = make_vehicle_state(localization, std::nullopt);
  const auto* status = std::get_if<Status>(&state);
  if (status == nullptr) return "accepted";
  EXPECT_EQ(status->code, StatusCode::kInvalidLocalization);
  return status->message;
}

TEST(VehicleState, IsThePlaneViewOfThePose) {
  Localization localization = localization_at(Pose2(Point2(10.0, 20.0), 0.5));
  localization.angular_velocity_body.z() = 0.2;
  const VehicleState state = state_of(localization);
  EXPECT_EQ(state.stamp, at_seconds(1.0));
  EXPECT_EQ(state.map_from_base.position(), Point2(10.0, 20.0));
  EXPECT_EQ(state.map_from_base.heading(), 0.5);
  EXPECT_NEAR(state.speed, 10.0, 1e-12);
  EXPECT_EQ(state.yaw_rate, 0.2);
}

TEST(VehicleState, TakesTheHeadingOverTheOrientation) {
  Localization localization = localization_at(Pose2(Point2::Zero(), 0.5));
  localization.map_from_body = yaw(-1.0);
  EXPECT_EQ(state_of(localization).map_from_base.heading(), 0.5);
}

TEST(VehicleState, TakesTheOrientationWhereTheHeadingIsNotGiven) {
  Localization localization = localization_at(Pose2());
  localization.heading = kNaN;
  localization.map_from_body = yaw(2.0) * Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitY());
  EXPECT_NEAR(state_of(localization).map_from_base.heading(), 2.0, 1e-12) << "whatever the pitch";
  localization.map_from_body.coeffs() *= 3.0;
  EXPECT_NEAR(state_of(localization).map_from_base.heading(), 2.0, 1e-12) << "whatever the norm";
}

TEST(VehicleState, WrapsTheHeading) {
  Localization localization = localization_at(Pose2());
  localization.heading = 3.0 * kPi / 2.0;
  EXPECT_NEAR(state_of(localization).map_from_base.heading(), -kPi / 2.0, 1e-12);
}

TEST(VehicleState, NeedsADirection) {
  Localization localization = localization_at(Pose2());
  localization.heading = kNaN;
  localization.map_from_body.coeffs().setZero();
  EXPECT_THAT(refusal_of(localization), HasSubstr("neither pose.heading nor pose.orientation"));
  localization.map_from_body.coeffs().setConstant(kNaN);
  EXPECT_THAT(refusal_of(localization), HasSubstr("neither pose.heading nor pose.orientation"));
}

TEST(VehicleState, NeedsAPositionAndNamesTheField) {
  Localization localization = localization_at(Pose2());
  localization.position.x() = kNaN;
  EXPECT_THAT(refusal_of(localization), HasSubstr("pose.position.x is nan"));
  localization.position = {0.0, std::numeric_limits<double>::infinity(), 0.0};
  EXPECT_THAT(refusal_of(localization), HasSubstr("pose.position.y is inf"));
}

TEST(VehicleState, DoesWithoutHeightVelocityAndRates) {
  Localization localization = localization_at(Pose2(Point2(1.0, 2.0), 0.3));
  localization.position.z() = kNaN;
  localization.linear_velocity.setConstant(kNaN);
  localization.angular_velocity_body.setConstant(kNaN);
  const VehicleState state = state_of(localization);
  EXPECT_TRUE(std::isnan(state.speed) && std::isnan(state.yaw_rate)) << "the poses before tell";
}

TEST(VehicleState, TakesTheSpeedOfTheChassisOverTheVelocity) {
  Chassis chassis;
  chassis.speed = -2.0;
  EXPECT_EQ(state_of(localization_at(Pose2()), chassis).speed, -2.0) << "negative in reverse gear";
  chassis.speed = kNaN;
  EXPECT_NEAR(state_of(localization_at(Pose2()), chassis).speed, 10.0, 1e-12) << "unless it says nothing";
}

TEST(VehicleState, IsReversingWhereTheVelocityPointsBack) {
  EXPECT_NEAR(state_of(localization_at(Pose2(Point2::Zero(), 1.0), -3.0)).speed, -3.0, 1e-12);
}

TEST(CarriedPose, OfTheSameLinkIsTheSame) {
  const Localization link = localization_at(Pose2(Point2(5.0, 6.0), 0.7));
  const Localization base = carry_to_base(link, Eigen::Isometry3d::Identity());
  EXPECT_NEAR((base.position - link.position).norm(), 0.0, 1e-12);
  EXPECT_NEAR(base.heading, 0.7, 1e-12);
  EXPECT_NEAR((base.linear_velocity - link.linear_velocity).norm(), 0.0, 1e-12);
}

TEST(CarriedPose, MovesWithTheLeverArmInMapDirections) {
  // An IMU 1.5 m ahead and 0.4 m to the left of base_link, on a vehicle that heads north.
  const Localization link = localization_at(Pose2(Point2(100.0, 200.0), kPi / 2.0));
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.translation() << -1.5, -0.4, 0.0;
  const Localization base = carry_to_base(link, link_from_base);
  EXPECT_NEAR((base.position.head<2>() - Point2(100.4, 198.5)).norm(), 0.0, 1e-12);
}

TEST(CarriedPose, HasTheVelocityOfARigidBody) {
  // Turning left at 0.5 rad/s about a point: the base, 2 m behind the link, moves sideways to the right.
  Localization link = localization_at(Pose2(Point2::Zero(), 0.0), 8.0);
  link.angular_velocity_body = {0.0, 0.0, 0.5};
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.translation() << -2.0, 0.0, 0.0;
  EXPECT_NEAR((carry_to_base(link, link_from_base).linear_velocity - Eigen::Vector3d(8.0, -1.0, 0.0)).norm(),
              0.0, 1e-12);
  link_from_base.translation() << 0.0, 1.0, 0.0;  // to the left: nearer to the centre of the turn
  EXPECT_NEAR((carry_to_base(link, link_from_base).linear_velocity - Eigen::Vector3d(7.5, 0.0, 0.0)).norm(),
              0.0, 1e-12);
}

TEST(CarriedPose, KeepsItsVelocityWhereTheRatesAreNotGiven) {
  Localization link = localization_at(Pose2(Point2::Zero(), 0.0), 8.0);
  link.angular_velocity_body.setConstant(kNaN);
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.translation() << -2.0, 0.0, 0.0;
  EXPECT_NEAR((carry_to_base(link, link_from_base).linear_velocity - link.linear_velocity).norm(), 0.0,
              1e-12);
}

TEST(CarriedPose, TurnsWithTheLink) {
  // A link that looks to the left, and lies 1 m to the left of the base.
  Localization link = localization_at(Pose2(Point2(3.0, 4.0), 0.2 + kPi / 2.0));
  link.angular_velocity_body = {0.1, 0.2, 0.3};
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.linear() = Eigen::AngleAxisd(-kPi / 2.0, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  link_from_base.translation() << -1.0, 0.0, 0.0;
  const Localization base = carry_to_base(link, link_from_base);
  EXPECT_NEAR(base.heading, 0.2, 1e-12);
  const Pose2 base_pose(Point2(base.position.x(), base.position.y()), 0.2);
  EXPECT_NEAR((base_pose.to_parent(Point2(0.0, 1.0)) - Point2(3.0, 4.0)).norm(), 0.0, 1e-12);
  EXPECT_NEAR((base.angular_velocity_body - Eigen::Vector3d(-0.2, 0.1, 0.3)).norm(), 0.0, 1e-12);
}

TEST(CarriedPose, UsesTheHeadingForTheArmWhereTheOrientationIsNotGiven) {
  Localization link = localization_at(Pose2(Point2(0.0, 0.0), kPi / 2.0));
  link.map_from_body.coeffs().setZero();
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.translation() << -1.5, 0.0, 0.0;
  EXPECT_NEAR((carry_to_base(link, link_from_base).position.head<2>() - Point2(0.0, -1.5)).norm(), 0.0,
              1e-12);
}

TEST(Speeds, ThatDisagreeAreTold) {
  Localization localization;
  localization.heading = 0.5 * kPi;
  localization.linear_velocity = {0.0, 10.0, 0.0};
  const auto told = [&](double speed) { return speeds_disagree(localization, Chassis{Time{}, speed}); };
  for (const double speed : {6.1, 10.0, 13.9}) EXPECT_FALSE(told(speed)) << speed;
  for (const double speed : {5.9, 14.1, 36.0, -10.0}) EXPECT_TRUE(told(speed)) << speed;
  EXPECT_THAT(*told(36.0),
              HasSubstr("speed_mps is 36 m/s by its gear, but localization: pose.linear_velocity is 10 m/s"));
  EXPECT_FALSE(told(std::numeric_limits<double>::quiet_NaN())) << "not given";
  localization.linear_velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_FALSE(told(36.0)) << "not given";
}

TEST(Jumps, AreWaysThatNoSpeedExplains) {
  const auto after = [](double way, double seconds) {
    VehicleState before, now;
    before.speed = now.speed = 10.0;
    now.stamp = at_seconds(seconds);
    now.map_from_base = Pose2(Point2(way, 0.0), 0.0);
    return has_jumped(before, now);
  };
  EXPECT_FALSE(after(4.9, 0.0));
  EXPECT_TRUE(after(5.1, 0.0));
  EXPECT_FALSE(after(19.0, 1.0));
  EXPECT_TRUE(after(21.0, 1.0));
  EXPECT_TRUE(after(kNaN, 1.0)) << "no place that can be driven to";
}

TEST(VehicleState, KeepsWhatLocalizationSaysOfItsNoise) {
  Localization localization;
  localization.heading = 1.0;
  EXPECT_TRUE(std::isnan(std::get<VehicleState>(make_vehicle_state(localization, {})).position_stddev));
  localization.position_stddev = 0.7;
  localization.heading_stddev = 0.02;
  const auto state = std::get<VehicleState>(make_vehicle_state(localization, {}));
  EXPECT_EQ(state.position_stddev, 0.7);
  EXPECT_EQ(state.heading_stddev, 0.02);
}

}  // namespace
}  // namespace relative_map::core
