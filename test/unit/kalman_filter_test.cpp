#include "relative_map/geometry/kalman_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

namespace relative_map::core {
namespace {

using Scalar = Eigen::Matrix<double, 1, 1>;

Scalar scalar(double value) {
  return Scalar::Constant(value);
}

TEST(KalmanFilter, MeasuringAConstantGivesTheMeanWeightedByInverseVariance) {
  const double prior = 4.0, noise = 0.5;
  KalmanFilter<1> filter(scalar(1.0), scalar(prior));
  const double measured[] = {3.0, 2.0, 4.5};
  double weighted = 1.0 / prior, weights = 1.0 / prior;
  for (const double z : measured) {
    filter.correct(scalar(z - filter.state()[0]), filter.expect(scalar(1.0), scalar(noise)));
    weighted += z / noise;
    weights += 1.0 / noise;
    EXPECT_NEAR(filter.state()[0], weighted / weights, 1e-12);
    EXPECT_NEAR(filter.covariance()(0, 0), 1.0 / weights, 1e-12);
  }
}

TEST(KalmanFilter, ARandomWalkSettlesToTheRootOfRiccatisEquation) {
  const double q = 0.01, r = 0.25;
  KalmanFilter<1> filter(scalar(0.0), scalar(10.0));
  for (int i = 0; i < 500; ++i) {
    filter.predict(scalar(1.0), scalar(q));
    filter.correct(scalar(0.0), filter.expect(scalar(1.0), scalar(r)));
  }
  // P- = P-  - P-^2 / (P- + r) + q
  const double predicted = 0.5 * (q + std::sqrt(q * q + 4.0 * q * r));
  EXPECT_NEAR(filter.covariance()(0, 0), predicted - q, 1e-12);
  EXPECT_NEAR(filter.stddev(0), std::sqrt(predicted - q), 1e-12);
}

TEST(KalmanFilter, AControlMovesTheStateAndNotItsCovariance) {
  const double dt = 0.1;
  Eigen::Matrix2d f;
  f << 1.0, dt, 0.0, 1.0;
  const Eigen::Vector2d b(0.5 * dt * dt, dt);
  const Eigen::Matrix2d start = Eigen::Vector2d(1.0, 2.0).asDiagonal();
  KalmanFilter<2> driven(Eigen::Vector2d(0.0, 1.0), start), free = driven;
  driven.predict(f, b, scalar(2.0), Eigen::Matrix2d::Zero());
  free.predict(f, Eigen::Matrix2d::Zero());
  EXPECT_NEAR(driven.state()[0], 0.1 + 0.01, 1e-15);
  EXPECT_NEAR(driven.state()[1], 1.2, 1e-15);
  EXPECT_TRUE(driven.covariance().isApprox(free.covariance()));
  EXPECT_NEAR(free.covariance()(0, 1), 2.0 * dt, 1e-15);
}

TEST(KalmanFilter, MeasurementsAtOnceAreMeasurementsOneByOne) {
  const Eigen::Matrix3d start = Eigen::Vector3d(1.0, 2.0, 3.0).asDiagonal();
  KalmanFilter<3> together(Eigen::Vector3d::Zero(), start), one_by_one = together;
  Eigen::Matrix<double, 2, 3> h;
  h << 1.0, 0.5, 0.0, 0.0, 1.0, -1.0;
  const Eigen::Vector2d z(1.0, -2.0), r(0.1, 0.3);
  together.correct(z, together.expect(h, Eigen::Matrix2d(r.asDiagonal())));
  for (int i = 0; i < 2; ++i) {
    const Eigen::RowVector3d row = h.row(i);
    one_by_one.correct(scalar(z[i] - row.dot(one_by_one.state())), one_by_one.expect(row, scalar(r[i])));
  }
  EXPECT_TRUE(together.state().isApprox(one_by_one.state(), 1e-12));
  EXPECT_TRUE(together.covariance().isApprox(one_by_one.covariance(), 1e-12));
}

TEST(KalmanFilter, TheCovarianceStaysPositiveUnderNearlyPerfectMeasurements) {
  KalmanFilter<3> filter(Eigen::Vector3d::Zero(), 1e6 * Eigen::Matrix3d::Identity());
  for (int i = 0; i < 1000; ++i) {
    const Eigen::RowVector3d h(1.0, 1e-3 * (i % 7), 1.0 + 1e-9 * i);
    filter.correct(scalar(0.0), filter.expect(h, scalar(1e-12)));
    filter.predict(Eigen::Matrix3d::Identity(), 1e-9 * Eigen::Matrix3d::Identity());
    ASSERT_TRUE(filter.covariance().isApprox(filter.covariance().transpose(), 0.0));
    ASSERT_GT(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(filter.covariance()).eigenvalues()[0], 0.0);
  }
}

TEST(KalmanFilter, MovingSomeStatesIsMovingAllWithTheOthersAtRest) {
  Eigen::Matrix3d root;
  root << 1.0, 0.2, 0.3, 0.0, 2.0, -0.5, 0.0, 0.0, 0.7;
  const Eigen::Vector3d x(1.0, 2.0, 3.0);
  KalmanFilter<3> part(x, root * root.transpose()), whole = part;
  Eigen::Matrix2d f, q;
  f << 1.0, 0.4, -0.1, 0.9;
  q << 0.2, 0.05, 0.05, 0.1;
  Eigen::Matrix3d f3 = Eigen::Matrix3d::Identity(), q3 = Eigen::Matrix3d::Zero();
  f3.bottomRightCorner<2, 2>() = f;
  q3.bottomRightCorner<2, 2>() = q;
  part.predict_part<1, 2>(f * x.tail<2>(), f, q);
  whole.predict(f3, q3);
  EXPECT_TRUE(part.state().isApprox(whole.state(), 1e-14));
  EXPECT_TRUE(part.covariance().isApprox(whole.covariance(), 1e-14));
}

TEST(KalmanFilter, CorrectsAsInJosephsForm) {
  Eigen::Matrix3d root;
  root << 1.0, 0.2, 0.3, 0.0, 2.0, -0.5, 0.0, 0.0, 0.7;
  const Eigen::Matrix3d p = root * root.transpose();
  KalmanFilter<3> filter(Eigen::Vector3d::Zero(), p);
  Eigen::Matrix<double, 2, 3> h;
  h << 1.0, 0.5, 0.0, 0.0, 1.0, -1.0;
  const Eigen::Matrix2d r = Eigen::Vector2d(0.1, 0.3).asDiagonal();
  const Eigen::Matrix<double, 3, 2> gain = p * h.transpose() * (h * p * h.transpose() + r).inverse();
  const Eigen::Matrix3d rest = Eigen::Matrix3d::Identity() - gain * h;
  filter.correct(Eigen::Vector2d(1.0, -1.0), filter.expect(h, r));
  EXPECT_TRUE(filter.covariance().isApprox(rest * p * rest.transpose() + gain * r * gain.transpose(), 1e-13));
  EXPECT_TRUE(filter.state().isApprox(gain * Eigen::Vector2d(1.0, -1.0), 1e-13));
}

TEST(KalmanFilter, TheSquaredDistanceCountsStandardDeviations) {
  const KalmanFilter<2> filter(Eigen::Vector2d::Zero(), Eigen::Vector2d(0.5, 3.0).asDiagonal());
  const Eigen::RowVector2d h(1.0, 0.0);
  EXPECT_NEAR(filter.expect(h, scalar(0.5)).squared_distance(scalar(3.0)), 9.0, 1e-12);
}

}  // namespace
}  // namespace relative_map::core
