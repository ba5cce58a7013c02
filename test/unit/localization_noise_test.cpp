#include "relative_map/pipeline/estimation/localization_noise.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

constexpr double kStep = 0.05;  // [s]

/// A minute on a straight at 10 m/s, with white noise.
LocalizationNoiseMeter listened(double position, double heading, int jump_each = 0) {
  LocalizationNoiseMeter meter{LocalizationNoise()};
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  double jumped = 0.0;
  const auto pose = [&](int i) {
    if (jump_each > 0 && i % jump_each == 0) jumped += 3.0;
    VehicleState state = test::vehicle_at(
        Pose2(Point2(10.0 * kStep * i + position * normal(random), jumped + position * normal(random)),
              heading * normal(random)),
        kStep * i);
    state.yaw_rate = 0.0;
    return state;
  };
  VehicleState last = pose(0);
  for (int i = 1; i < 1200; ++i) {
    const VehicleState now = pose(i);
    meter.listen(last, now);
    last = now;
  }
  return meter;
}

TEST(LocalizationNoise, WhiteNoiseIsMeasured) {
  for (const double position : {0.05, 0.2, 0.5}) {
    const LocalizationNoiseMeter meter = listened(position, 0.01);
    EXPECT_NEAR(meter.position_stddev(), position, 0.35 * position);
    EXPECT_NEAR(meter.heading_stddev(), 0.01, 0.004);
  }
}

TEST(LocalizationNoise, IsNeverLessThanAGoodReceivers) {
  const LocalizationNoiseMeter meter = listened(0.0, 0.0);
  EXPECT_EQ(meter.position_stddev(), LocalizationNoise().least_position_noise);
  EXPECT_EQ(meter.heading_stddev(), LocalizationNoise().least_heading_noise);
}

TEST(LocalizationNoise, JumpsAreNoNoise) {
  EXPECT_NEAR(listened(0.05, 0.01, 100).position_stddev(), 0.05, 0.05);
}

/// The walk that it measures of a bias that walks by `walk` [m/sqrt(s)].
double walk_measured(double walk, unsigned seed) {
  LocalizationNoiseMeter meter{LocalizationNoise()};
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  double bias = 0.0;
  for (int i = 0; i < 300; ++i) {
    meter.see_bias(at_seconds(2.0 * i), Point2::UnitY(), Point2(7.0, bias), 0.05);
    bias += walk * std::sqrt(2.0) * normal(random);
  }
  return meter.position_walk();
}

TEST(LocalizationNoise, TheWalkOfTheBiasIsMeasuredToTheSide) {
  for (unsigned seed = 1; seed < 5; ++seed) {
    EXPECT_LT(walk_measured(0.0, seed), 0.05);
    EXPECT_NEAR(walk_measured(0.3, seed), 0.3, 0.15);
  }
}

TEST(LocalizationNoise, WhatIsNoNumberOrLongAgoTellsNothing) {
  LocalizationNoiseMeter meter{LocalizationNoise()};
  const double before = meter.position_stddev();
  VehicleState last = test::vehicle_at(Pose2(), 1.0),
               now = test::vehicle_at(Pose2(Point2(test::kNaN, 0.0), 0.0), 1.1);
  meter.listen(last, now);
  now = test::vehicle_at(Pose2(Point2(500.0, 0.0), 0.0), 9.0);
  meter.listen(last, now);
  EXPECT_EQ(meter.position_stddev(), before);
}

}  // namespace
}  // namespace relative_map::core
