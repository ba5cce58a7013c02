#include "relative_map/pipeline/motion/pose_buffer.hpp"

#include <gtest/gtest.h>

#include "support/lines.hpp"
#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using test::vehicle_at;

TEST(PoseBuffer, KnowsNothingAtFirst) {
  EXPECT_FALSE(PoseBuffer().at(at_seconds(1.0)));
}

TEST(PoseBuffer, InterpolatesBetweenPoses) {
  PoseBuffer buffer;
  buffer.add(vehicle_at(Pose2(Point2(0.0, 0.0), kPi - 0.1), 1.0, 90.0));
  buffer.add(vehicle_at(Pose2(Point2(4.0, 8.0), -kPi + 0.1), 1.1, 90.0));
  const std::optional<Pose2> between = buffer.at(at_seconds(1.025));
  ASSERT_TRUE(between);
  EXPECT_NEAR((between->position() - Point2(1.0, 2.0)).norm(), 0.0, 1e-9);
  EXPECT_NEAR(between->heading(), kPi - 0.05, 1e-9) << "the short way round";
  EXPECT_EQ(buffer.at(at_seconds(1.1))->position(), Point2(4.0, 8.0));
  EXPECT_EQ(buffer.at(at_seconds(1.0))->position(), Point2(0.0, 0.0));
}

TEST(PoseBuffer, CarriesOnAlongTheCircleALittleBeyondItsPoses) {
  PoseBuffer buffer;
  VehicleState state = vehicle_at(Pose2(Point2(1.0, 2.0), 0.5), 1.0, 10.0);
  state.yaw_rate = 0.4;
  buffer.add(state);
  for (const double beyond : {-0.25, -0.1, 0.1, 0.25}) {
    const std::optional<Pose2> pose = buffer.at(at_seconds(1.0 + beyond));
    ASSERT_TRUE(pose) << beyond;
    const Pose2 truth = test::along_arc(state.map_from_base, 0.04, 10.0 * beyond);
    EXPECT_NEAR((pose->position() - truth.position()).norm(), 0.0, 1e-7);
    EXPECT_NEAR(pose->heading(), truth.heading(), 1e-7);
  }
  EXPECT_FALSE(buffer.at(at_seconds(1.4)));
  EXPECT_FALSE(buffer.at(at_seconds(0.6)));
}

TEST(PoseBuffer, CarriesOnBackwardsForAReversingVehicle) {
  PoseBuffer buffer;
  buffer.add(vehicle_at(Pose2(Point2(0.0, 0.0), 0.0), 1.0, -2.0));
  EXPECT_NEAR(buffer.at(at_seconds(1.1))->position().x(), -0.2, 1e-9);
}

TEST(PoseBuffer, CarriesOnWithTheTurnOfItsPosesWhereTheYawRateIsNotGiven) {
  PoseBuffer buffer;
  const Pose2 start(Point2(3.0, 1.0), 2.0);
  for (const double t : {0.9, 1.0}) {
    VehicleState state = vehicle_at(test::along_arc(start, 0.04, 10.0 * t), t, 10.0);
    state.yaw_rate = kNaN;
    buffer.add(state);
  }
  const std::optional<Pose2> pose = buffer.at(at_seconds(1.2));
  ASSERT_TRUE(pose);
  EXPECT_NEAR((pose->position() - test::along_arc(start, 0.04, 12.0).position()).norm(), 0.0, 1e-6);
}

TEST(PoseBuffer, CarriesOnStraightWhereNothingIsKnownOfTheTurn) {
  PoseBuffer buffer;
  VehicleState state = vehicle_at(Pose2(), 1.0, 10.0);
  state.yaw_rate = kNaN;
  buffer.add(state);
  EXPECT_NEAR((buffer.at(at_seconds(1.1))->position() - Point2(1.0, 0.0)).norm(), 0.0, 1e-9);
}

TEST(PoseBuffer, MeasuresTheSpeedOfItsPosesWhereItIsNotGiven) {
  for (const double speed : {25.0, -3.0}) {
    for (const double period : {0.01, 0.1, 0.2}) {  // [s]
      PoseBuffer buffer;
      for (double t = 0.0; t < 1.0; t += period) {
        VehicleState state = vehicle_at(test::along_arc(Pose2(), 0.02, speed * t), t, kNaN);
        state.yaw_rate = 0.02 * speed;
        buffer.add(state);
      }
      EXPECT_NEAR(buffer.newest().speed, speed, 0.01 * std::abs(speed)) << "chords are a little short";
    }
  }
}

TEST(PoseBuffer, ForgetsTheFutureWhereTimeIsSetBack) {
  PoseBuffer buffer;
  for (int i = 0; i < 10; ++i) buffer.add(vehicle_at(Pose2(Point2(i, 0.0), 0.0), 5.0 + 0.1 * i, 0.0));
  buffer.add(vehicle_at(Pose2(Point2(-1.0, 0.0), 0.0), 5.25, 0.0));
  EXPECT_FALSE(buffer.at(at_seconds(5.8)));
  EXPECT_EQ(buffer.at(at_seconds(5.25))->position().x(), -1.0);
}

TEST(PoseBuffer, KeepsItsHistoryOverAJump) {
  PoseBuffer buffer;
  buffer.add(vehicle_at(Pose2(Point2(0.0, 0.0), 0.0), 1.0, 10.0));
  buffer.add(vehicle_at(Pose2(Point2(30.0, 0.0), 0.0), 1.1, 10.0));
  EXPECT_NEAR(buffer.at(at_seconds(1.05))->position().x(), 29.5, 1e-9) << "not half way between";
  EXPECT_NEAR(buffer.at(at_seconds(1.0))->position().x(), 29.0, 1e-9) << "where it lies from the new one";
  buffer.add(vehicle_at(Pose2(Point2(34.0, 0.0), 0.0), 1.2, 10.0));
  EXPECT_NEAR(buffer.at(at_seconds(1.15))->position().x(), 32.0, 1e-9) << "3 m more than driven is no jump";
}

TEST(PoseBuffer, AJumpMovesNothingThatWasSeen) {
  PoseBuffer straight, jumping;
  for (int i = 0; i <= 40; ++i) {
    const double t = 0.05 * i;
    VehicleState state = vehicle_at(test::along_arc(Pose2(), 0.02, 12.0 * t), t, 12.0);
    state.yaw_rate = 0.24;
    straight.add(state);
    if (t > 1.5) state.map_from_base = Pose2(Point2(-40.0, 25.0), 0.4).to_parent(state.map_from_base);
    jumping.add(state);
  }
  for (const double ago : {0.2, 1.0, 1.9}) {
    const auto seen = [&](const PoseBuffer& buffer) {
      return buffer.at(at_seconds(2.0))->to_local(*buffer.at(at_seconds(2.0 - ago)));
    };
    EXPECT_NEAR((seen(straight).position() - seen(jumping).position()).norm(), 0.0, 0.01) << ago;
    EXPECT_NEAR(seen(straight).heading(), seen(jumping).heading(), 1e-6) << ago;
  }
}

TEST(PoseBuffer, KeepsAsLongAsItIsTold) {
  PoseBuffer buffer;
  buffer.keep(std::chrono::seconds(8));
  for (int i = 0; i <= 1000; ++i) buffer.add(vehicle_at(Pose2(Point2(i, 0.0), 0.0), 0.02 * i, 50.0));
  EXPECT_TRUE(buffer.at(at_seconds(12.1)));
  EXPECT_FALSE(buffer.at(at_seconds(11.5)));
}

TEST(PoseBuffer, KeepsAFewSecondsOnly) {
  PoseBuffer buffer;
  for (int i = 0; i <= 1000; ++i) buffer.add(vehicle_at(Pose2(Point2(i, 0.0), 0.0), 0.01 * i, 100.0));
  EXPECT_TRUE(buffer.at(at_seconds(8.0)));
  EXPECT_FALSE(buffer.at(at_seconds(5.0)));
}

}  // namespace
}  // namespace relative_map::core
