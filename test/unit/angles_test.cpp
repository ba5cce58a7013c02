#include "relative_map/geometry/angles.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace relative_map::core {
namespace {

TEST(Angles, AreWrappedIntoTheHalfOpenTurn) {
  EXPECT_EQ(normalize_angle(0.0), 0.0);
  EXPECT_EQ(normalize_angle(kPi), kPi);
  EXPECT_EQ(normalize_angle(-kPi), kPi) << "-pi is outside of (-pi, pi]";
  EXPECT_NEAR(normalize_angle(3.0 * kPi / 2.0), -kPi / 2.0, 1e-15);
  EXPECT_NEAR(normalize_angle(-3.0 * kPi / 2.0), kPi / 2.0, 1e-15);
  EXPECT_NEAR(normalize_angle(0.25 + 200.0 * kPi), 0.25, 1e-12);
}

TEST(Angles, StayInTheHalfOpenTurnWhateverComesIn) {
  for (int i = -4000; i <= 4000; ++i) {
    const double angle = i * kPi / 7.0;
    const double wrapped = normalize_angle(angle);
    EXPECT_GT(wrapped, -kPi) << angle;
    EXPECT_LE(wrapped, kPi) << angle;
    EXPECT_NEAR(std::cos(wrapped), std::cos(angle), 1e-12);
    EXPECT_NEAR(std::sin(wrapped), std::sin(angle), 1e-12);
  }
}

TEST(Angles, NotFiniteInGivesNotFiniteOut) {
  EXPECT_FALSE(std::isfinite(normalize_angle(std::numeric_limits<double>::infinity())));
  EXPECT_FALSE(std::isfinite(normalize_angle(std::numeric_limits<double>::quiet_NaN())));
}

TEST(Angles, DifferTheShortWayRound) {
  EXPECT_NEAR(angle_difference(3.1, -3.1), 6.2 - 2.0 * kPi, 1e-15);
  EXPECT_NEAR(angle_difference(-3.1, 3.1), 2.0 * kPi - 6.2, 1e-15);
  EXPECT_EQ(angle_difference(kPi, 0.0), kPi);
  EXPECT_EQ(angle_difference(0.0, kPi), kPi);
}

TEST(Angles, AreInterpolatedTheShortWayRound) {
  EXPECT_NEAR(interpolate_angle(3.0, -3.0, 0.5), kPi, 1e-15);
  EXPECT_NEAR(interpolate_angle(3.1, -3.1, 0.25), 3.1 + 0.25 * (2.0 * kPi - 6.2), 1e-15);
  EXPECT_EQ(interpolate_angle(0.2, 0.4, 0.0), 0.2);
  EXPECT_NEAR(interpolate_angle(0.2, 0.4, 1.0), 0.4, 1e-15);
}

}  // namespace
}  // namespace relative_map::core
