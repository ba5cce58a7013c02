#include "relative_map/prediction/motion_filter.hpp"

#include <gmock/gmock.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "relative_map/prediction/noise_meter.hpp"
#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

constexpr AccelerationModel kModel{3.0, 1.2, 0.5};

TEST(Singer, TransitionIsThatOfAnAccelerationThatFades) {
  // v' = a, a' = -a / time, by small steps.
  Eigen::Vector3d state(1.0, 2.0, 3.0);
  const Eigen::Vector3d expected = singer_transition(2.0, 1.5) * state;
  const int steps = 200000;
  for (int i = 0; i < steps; ++i) {
    const double dt = 2.0 / steps;
    state += dt * Eigen::Vector3d(state[1], state[2], -state[2] / 1.5);
  }
  EXPECT_LT((state - expected).norm(), 1e-4);
}

TEST(Singer, NoiseIsTheIntegralOfWhatStirsTheAcceleration) {
  for (const double dt : {0.01, 0.0299, 0.0301, 0.1, 1.0, 8.0}) {
    const double time = 3.0;
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    const int steps = 4000;
    for (int i = 0; i < steps; ++i) {
      const Eigen::Vector3d reach = singer_transition((i + 0.5) * dt / steps, time).col(2);
      sum += 2.0 / time * dt / steps * reach * reach.transpose();
    }
    EXPECT_LT((singer_noise(dt, time) - sum).norm(), 0.01 * sum.norm()) << dt;
  }
}

TEST(MotionFilter, NoiseDependsOnTheTimeThatPasses) {
  MotionFilter once(seen(1, 0.0, 0.0), 0.2, {}), often = once;
  once.predict(1.0, 0.3, kModel);
  for (int i = 0; i < 10; ++i) often.predict(0.1, 0.3, kModel);
  EXPECT_LT((once.state() - often.state()).norm(), 1e-9);
  EXPECT_LT((once.covariance() - often.covariance()).norm(), 1e-2 * once.covariance().norm());
}

TEST(MotionFilter, AnUnknownVelocityIsNotTrusted) {
  MotionFilter filter(seen(1, 0.0, 0.0), 0.1, {});
  filter.predict(0.1, 0.0, kModel);
  filter.update_position({2.0, 0.0}, 0.1);
  EXPECT_NEAR(filter.velocity().x(), 20.0, 1.5);  // the seed's P0 of 0.1 would say 1
}

TEST(MotionFilter, SeedsNumbersArePreset) {
  MotionFilterParam param;
  param.preset = "seed";
  MotionFilter filter(seen(1, 0.0, 0.0), 0.1, param);
  const auto before = filter.covariance();
  filter.predict(1e-9, 0.0, kModel);
  // Q is 0.01, whatever dt.
  EXPECT_NEAR(filter.covariance()(0, 0) - before(0, 0), 0.01, 1e-6);
}

/// The mean squared error in its own standard deviations: 1 where the filter knows how good it is.
double consistency(double noise, double dt) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal(0.0, 1.0);
  const Eigen::Matrix3d f = singer_transition(dt, kModel.time);
  const Eigen::LLT<Eigen::Matrix3d> root(singer_noise(dt, kModel.time));
  double sum = 0.0;
  int count = 0;
  for (int run = 0; run < 200; ++run) {
    Eigen::Vector3d x(0.0, 10.0 + normal(random), kModel.along * normal(random));
    MotionFilter filter(seen(1, x[0] + noise * normal(random), noise * normal(random)), noise, {});
    for (int i = 0; i < 30; ++i) {
      const double n0 = normal(random), n1 = normal(random), n2 = normal(random);
      x = f * x + kModel.along * (root.matrixL() * Eigen::Vector3d(n0, n1, n2)).eval();
      filter.predict(dt, 0.0, kModel);
      const double nx = normal(random), ny = normal(random);
      filter.update_position({x[0] + noise * nx, noise * ny}, noise);
    }
    Eigen::Vector3d error(filter.state()[0] - x[0], filter.state()[2] - x[1], filter.state()[4] - x[2]);
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) p(i, j) = filter.covariance()(2 * i, 2 * j);
    }
    sum += error.dot(p.inverse() * error) / 3.0;
    ++count;
  }
  return sum / count;
}

TEST(MotionFilter, KnowsHowGoodItIs) {
  for (const double noise : {0.05, 0.2, 0.5}) {
    for (const double dt : {0.05, 0.1, 0.5})
      EXPECT_NEAR(consistency(noise, dt), 1.0, 0.2) << noise << " " << dt;
  }
}

TEST(NoiseMeter, MeasuresWhiteNoiseOfWhatMoves) {
  for (const double noise : {0.1, 0.2, 0.4}) {
    Watch watch;
    watch.watch(
        [](double t) {
          std::vector<SeenRoadUser> users;
          for (int i = 0; i < 10; ++i) users.push_back(seen(i, (5.0 + i) * t + 0.5 * t * t, 10.0 * i));
          return users;
        },
        0.0, 3.0, noise);
    EXPECT_NEAR(watch.prediction.store().position_stddev(), noise, 0.15 * noise);
  }
}

TEST(NoiseMeter, HasBoundsAndSkipsUnevenSteps) {
  NoiseMeter meter{MotionFilterParam{}};
  const Point2 wild[4] = {{0.0, 0.0}, {50.0, 0.0}, {-50.0, 9.0}, {7.0, 3.0}};
  const double uneven[3] = {0.1, 0.2, 0.1}, even[3] = {0.1, 0.1, 0.1};
  const double before = meter.stddev();
  meter.add(wild, uneven);
  meter.end_frame();
  EXPECT_EQ(meter.stddev(), before);
  meter.add(wild, even);
  meter.end_frame();
  EXPECT_LE(meter.stddev(), MotionFilterParam{}.max_position_stddev);
}

}  // namespace
}  // namespace relative_map::core::test
