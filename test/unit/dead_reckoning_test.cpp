#include "relative_map/pipeline/motion/dead_reckoning.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include "support/lines.hpp"

namespace relative_map::core {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

VehicleState moving(double seconds, double speed, double yaw_rate) {
  VehicleState state;
  state.stamp = at_seconds(seconds);
  state.map_from_base = Pose2(Point2(kNaN, kNaN), kNaN);  // odometry alone
  state.speed = speed;
  state.yaw_rate = yaw_rate;
  return state;
}

void expect_near(const std::optional<Pose2>& pose, const Pose2& truth, double tolerance) {
  ASSERT_TRUE(pose);
  EXPECT_NEAR((pose->position() - truth.position()).norm(), 0.0, tolerance);
  EXPECT_NEAR(angle_difference(pose->heading(), truth.heading()), 0.0, tolerance);
}

TEST(DeadReckoning, KnowsNothingAtFirst) {
  DeadReckoning way;
  EXPECT_FALSE(way.newest());
  EXPECT_FALSE(way.at(at_seconds(1.0)));
  EXPECT_FALSE(way.moved(at_seconds(1.0), at_seconds(1.0)));
  EXPECT_FALSE(way.way(at_seconds(1.0), at_seconds(1.0)));
}

TEST(DeadReckoning, IsExactOnACircleAtAnyTimeForwardsAndBackwards) {
  for (const double speed : {12.0, -3.0}) {
    for (const double kappa : {0.05, -0.02, 0.0}) {
      DeadReckoning way;
      for (const double t : {10.0, 10.02, 10.5, 10.51, 11.3, 12.0}) way.add(moving(t, speed, speed * kappa));
      for (const double from : {9.8, 10.0, 10.3, 11.95, 12.2}) {
        for (const double to : {9.9, 10.505, 11.0, 12.0, 12.25}) {
          const double driven = speed * (to - from);
          expect_near(way.moved(at_seconds(from), at_seconds(to)), test::along_arc(Pose2(), kappa, driven),
                      1e-6);
          EXPECT_NEAR(*way.way(at_seconds(from), at_seconds(to)), std::abs(speed) * (to - from), 1e-6);
        }
      }
    }
  }
}

TEST(DeadReckoning, FollowsSpeedsAndTurnsThatChange) {
  // v = 5 + 3 t, yaw rate 0.2 sin t: integrated finely by hand.
  const auto speed = [](double t) { return 5.0 + 3.0 * t; };
  const auto yaw_rate = [](double t) { return 0.2 * std::sin(t); };
  Pose2 truth;
  constexpr double kStep = 1e-4;
  for (double t = 0.5 * kStep; t < 3.0; t += kStep) {
    truth = carried_on({Time{}, truth, speed(t), yaw_rate(t)}, kStep);
  }
  for (const double period : {0.01, 0.05, 0.2}) {
    DeadReckoning way;
    for (int i = 0; i * period <= 3.0 + 1e-9; ++i) {
      way.add(moving(100.0 + i * period, speed(i * period), yaw_rate(i * period)));
    }
    expect_near(way.moved(at_seconds(100.0), at_seconds(103.0)), truth, 1.0 * period * period + 1e-5);
  }
}

TEST(DeadReckoning, GoesThereAndBackAgain) {
  std::mt19937_64 engine(7);
  std::uniform_real_distribution<double> random(-1.0, 1.0);
  DeadReckoning way;
  double t = 5.0;
  for (int i = 0; i < 60; ++i)
    way.add(moving(t += 0.03 + 0.02 * random(engine), 8.0 * random(engine), random(engine)));
  for (int i = 0; i < 200; ++i) {
    const auto some_time = [&] { return at_seconds(t - 0.8 + 0.8 * random(engine)); };
    const Time a = some_time(), b = some_time(), c = some_time();
    const Pose2 there = *way.moved(a, b), on = *way.moved(b, c);
    expect_near(there.to_parent(*way.moved(b, a)), Pose2(), 1e-9);
    expect_near(way.moved(a, c), there.to_parent(on), 1e-9);
    EXPECT_NEAR(*way.way(a, b) + *way.way(b, c), *way.way(a, c), 1e-9);
  }
}

TEST(DeadReckoning, IsContinuous) {
  DeadReckoning way;
  for (const double t : {1.0, 1.1, 1.2}) way.add(moving(t, 10.0 + 50.0 * (t - 1.0), 3.0 * (t - 1.0)));
  for (const double t : {1.0, 1.1, 1.2}) {
    const double just = 1e-8;
    expect_near(way.moved(at_seconds(t - just), at_seconds(t + just)), Pose2(), 1e-6);
  }
}

TEST(DeadReckoning, KeepsWhatItWasGivenWhereANumberIsMissing) {
  DeadReckoning way;
  way.add(moving(1.0, 10.0, 0.0));
  way.add(moving(1.5, kNaN, kNaN));
  expect_near(way.moved(at_seconds(1.0), at_seconds(1.5)), Pose2(Point2(5.0, 0.0), 0.0), 1e-9);
  DeadReckoning nothing;
  nothing.add(moving(1.0, kNaN, kNaN));
  expect_near(nothing.moved(at_seconds(1.0), at_seconds(1.2)), Pose2(), 1e-9);
}

TEST(DeadReckoning, DropsWhatIsNotLater) {
  DeadReckoning way;
  way.add(moving(1.0, 10.0, 0.0));
  way.add(moving(1.1, 10.0, 0.0));
  for (const double stray : {1.1, 1.05, 0.2}) way.add(moving(stray, -50.0, 2.0));
  way.add(moving(1.2, 10.0, 0.0));
  expect_near(way.moved(at_seconds(1.0), at_seconds(1.2)), Pose2(Point2(2.0, 0.0), 0.0), 1e-9);
}

TEST(DeadReckoning, KeepsAsLongAsItIsTold) {
  DeadReckoning way;
  way.keep(std::chrono::seconds(10));
  for (int i = 0; i <= 4000; ++i) way.add(moving(0.05 * i, 1.0, 0.0));
  EXPECT_TRUE(way.at(at_seconds(190.5)));
  EXPECT_FALSE(way.at(at_seconds(189.0)));
  EXPECT_FALSE(way.at(at_seconds(200.4)));
}

TEST(DeadReckoning, NothingIsKnownOfTheTimeBeforeAPause) {
  DeadReckoning way;
  way.add(moving(1.0, 10.0, 0.0));
  way.add(moving(2.5, 10.0, 0.0));
  EXPECT_FALSE(way.at(at_seconds(1.0)));
  EXPECT_TRUE(way.at(at_seconds(2.4)));
  EXPECT_EQ(way.newest(), at_seconds(2.5));
}

}  // namespace
}  // namespace relative_map::core
