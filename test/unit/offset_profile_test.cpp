#include "relative_map/pipeline/estimation/offset_profile.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

namespace relative_map::core {
namespace {

OffsetProfile::Knots some_knots() {
  OffsetProfile::Knots knots;
  for (int i = 0; i < OffsetProfile::kKnots; ++i) knots[i] = 0.1 * std::sin(0.7 * i) + 0.05;
  return knots;
}

TEST(OffsetProfile, EqualKnotsAreTheirOwnValueBetweenThem) {
  const OffsetProfile profile(OffsetProfile::Knots::Constant(0.2));
  for (double place = 1.0; place <= OffsetProfile::kKnots - 2.0; place += 0.13) {
    EXPECT_NEAR(profile.at(place), 0.2, 1e-12) << place;
  }
}

TEST(OffsetProfile, SharesAreWhatTheOffsetIsMadeOf) {
  const OffsetProfile::Knots knots = some_knots();
  const OffsetProfile profile(knots);
  for (double place = -6.0; place < OffsetProfile::kKnots + 6.0; place += 0.17) {
    EXPECT_NEAR(OffsetProfile::shares(place).dot(knots), profile.at(place), 1e-12) << place;
  }
}

TEST(OffsetProfile, IsSmoothInHeadingAndCurvature) {
  const OffsetProfile profile(some_knots());
  const double h = 1e-4;
  for (double place = -5.0; place < OffsetProfile::kKnots + 5.0; place += 1.0) {  // at the joins
    const auto second = [&](double at) {
      return (profile.at(at + h) - 2.0 * profile.at(at) + profile.at(at - h)) / (h * h);
    };
    EXPECT_NEAR(second(place - 2.0 * h), second(place + 2.0 * h), 1e-3) << place;
  }
}

TEST(OffsetProfile, FadesToNothingPastWhatWasSeen) {
  const OffsetProfile profile(OffsetProfile::Knots::Constant(0.3));
  const int last = OffsetProfile::kKnots - 1;
  for (double place = last; place < last + 20.0; place += 0.5) {
    EXPECT_LE(std::abs(profile.at(place)), 0.3) << place;
    if (place > last + 8.0) {
      EXPECT_LT(std::abs(profile.at(place)), 0.05 * 0.3) << place;
    }
  }
  EXPECT_EQ(profile.at(last + 20.0), 0.0);
}

TEST(OffsetProfile, APriorOfOneMoreKnotIsThePriorOfAllOfThem) {
  // The expectation and variance of a knot, given its two neighbours, agree with the joint covariance.
  const OffsetProfile::Covariance p = OffsetProfile::prior(0.1);
  const OffsetProfile::Next next = OffsetProfile::next(0.1);
  const Eigen::Vector2d shares(next.from_near, next.from_far);
  const Eigen::Matrix2d known = p.block<2, 2>(0, 0);
  const Eigen::Vector2d cross(p(2, 1), p(2, 0));
  EXPECT_TRUE((known * shares).isApprox(cross, 1e-12));
  EXPECT_NEAR(next.variance, p(2, 2) - cross.dot(shares), 1e-15);
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<OffsetProfile::Covariance>(p).eigenvalues()[0], 0.0);
}

}  // namespace
}  // namespace relative_map::core
