#include "relative_map/pipeline/motion/odometry_check.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;

/// A vehicle at 10 m/s on a circle, and what its sensors make of it.
struct Circle {
  double kappa = 0.02;  ///< [1/m]
  double speed = 10.0;  ///< [m/s] as told
  double yaw_rate = 0.2;
  double period = 0.05;  ///< [s] of poses
  double t = 0.0;
  Point2 jumped = Point2::Zero();

  void drive(double seconds, OdometryCheck& check) {
    for (const double end = t + seconds; t < end; t += period) {
      const Pose2 truth = test::along_arc(Pose2(), kappa, 10.0 * t);
      VehicleState state;
      state.stamp = at_seconds(100.0 + t);
      state.map_from_base = Pose2(truth.position() + jumped, truth.heading());
      state.speed = speed;
      state.yaw_rate = yaw_rate;
      check.add(state);
    }
  }
};

TEST(OdometryCheck, TrustsWhatFits) {
  OdometryCheck check;
  Circle vehicle;
  vehicle.speed = 10.4;  // as worn tyres have it
  vehicle.yaw_rate = 0.21;
  vehicle.drive(60.0, check);
  EXPECT_TRUE(check.trusts_speed() && check.trusts_yaw_rate());
}

TEST(OdometryCheck, FindsOutASpeedWithinFiveSecondsAndForgives) {
  for (const double speed : {0.0, 36.0, -10.0}) {
    OdometryCheck check;
    Circle vehicle;
    vehicle.speed = speed;
    vehicle.drive(5.0, check);
    EXPECT_FALSE(check.trusts_speed()) << speed;
    EXPECT_TRUE(check.trusts_yaw_rate());
    vehicle.speed = 10.0;
    vehicle.drive(7.0, check);
    EXPECT_TRUE(check.trusts_speed()) << speed;
  }
}

TEST(OdometryCheck, FindsOutAYawRateInACurveOnly) {
  for (const double factor : {-1.0, 57.3, 0.0}) {
    OdometryCheck check;
    Circle vehicle;
    vehicle.kappa = 0.0;
    vehicle.yaw_rate = 0.0;
    vehicle.drive(20.0, check);
    EXPECT_TRUE(check.trusts_yaw_rate());
    vehicle.kappa = 0.02;
    vehicle.t = 0.0;
    OdometryCheck in_curve;
    vehicle.yaw_rate = factor * 0.2;
    vehicle.drive(5.0, in_curve);
    EXPECT_FALSE(in_curve.trusts_yaw_rate()) << factor;
    EXPECT_TRUE(in_curve.trusts_speed());
  }
}

TEST(OdometryCheck, OneJumpOfLocalizationIsNoVerdict) {
  OdometryCheck check;
  Circle vehicle;
  vehicle.drive(5.0, check);
  for (int i = 0; i < 3; ++i) {
    vehicle.jumped += Point2(3.0, 0.0);
    vehicle.drive(6.0, check);
    EXPECT_TRUE(check.trusts_speed());
  }
}

TEST(OdometryCheck, NothingIsSaidOfWhatIsNotGiven) {
  OdometryCheck check;
  Circle vehicle;
  vehicle.speed = vehicle.yaw_rate = kNaN;
  vehicle.drive(20.0, check);
  EXPECT_TRUE(check.trusts_speed() && check.trusts_yaw_rate());
}

TEST(OdometryCheck, AVehicleAtRestTellsNothing) {
  OdometryCheck check;
  VehicleState state;
  for (int i = 0; i < 500; ++i) {
    state.stamp = at_seconds(0.05 * i);
    state.map_from_base = Pose2(Point2(i % 2 == 0 ? 0.2 : -0.2, 0.1), 0.01 * (i % 3));  // noise
    check.add(state);
  }
  EXPECT_TRUE(check.trusts_speed() && check.trusts_yaw_rate());
}

TEST(OdometryCheck, DriftAndJumpsAtRestAreNoVerdictAgainstASpeedOfZero) {
  for (const double drift : {0.3, 0.7, 1.1}) {  // [m/s] ahead
    OdometryCheck check;
    for (int i = 0; i < 1200; ++i) {
      VehicleState state;
      state.stamp = at_seconds(0.05 * i);
      state.map_from_base =
          Pose2(Point2(0.05 * i * drift + (i / 60) * 3.0, 0.0), 0.0);  // put on by 3 m in 3 s
      check.add(state);
    }
    EXPECT_TRUE(check.trusts_speed()) << drift;
  }
}

}  // namespace
}  // namespace relative_map::core
