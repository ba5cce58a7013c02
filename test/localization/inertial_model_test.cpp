// The filter's models: closed forms, and every Jacobian against differences.
#include <gmock/gmock.h>

#include "relative_map/localization/inertial_filter/mechanization.hpp"
#include "relative_map/localization/inertial_filter/observations.hpp"
#include "support.hpp"

namespace relative_map::core {
namespace {

using namespace error;

NavigationState some_state() {
  NavigationState state;
  state.position = {120.0, -40.0, 3.0};
  state.velocity = {8.0, 5.0, -0.4};
  state.attitude = rotation_by({0.05, -0.1, 2.1});
  state.gyro_bias = {0.01, -0.02, 0.005};
  state.accel_bias = {0.1, 0.05, -0.1};
  state.wheel_scale = 1.02;
  state.mount_pitch = 0.02;
  state.mount_yaw = -0.03;
  state.stamp_offset = 0.08;
  return state;
}

const ImuSample kSample{{0.05, -0.03, 0.4}, {0.6, 1.8, 9.7}};
const Motion kMotion{{0.04, -0.01, 0.395}, {1.2, -0.7, 0.1}};
const Eigen::Vector3d kLever(-1.2, 0.3, -0.9);

NavigationState moved_by(const NavigationState& state, int i, double step) {
  NavigationState moved = state;
  ErrorState by = ErrorState::Zero();
  by(i) = step;
  ErrorCovariance unused = ErrorCovariance::Identity();
  inject(by, moved, unused);
  return moved;
}

TEST(Mechanization, StandingStaysWhereItIs) {
  KnownDrive drive;
  drive.stand = 1e6;
  const TangentPlane plane(drive.origin);
  NavigationState state;
  state.attitude = Eigen::AngleAxisd(drive.first_heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  for (int i = 0; i < 6000; ++i) move(state, drive.imu_at(0.0), earth_effects(plane, state.position), 0.01);
  EXPECT_LT(state.position.norm(), 1e-6);
  EXPECT_LT(state.velocity.norm(), 1e-7);
  EXPECT_NEAR(state.yaw(), drive.first_heading, 1e-9);
}

TEST(Mechanization, FollowsAWeavingDrive) {
  KnownDrive drive;
  drive.stand = 0.0;
  const TangentPlane plane(drive.origin);
  NavigationState state;
  state.attitude = Eigen::AngleAxisd(drive.first_heading, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const double dt = 0.002;
  for (int i = 0; i < 10'000; ++i) {
    // Of the middle of the step: what two samples' mean stands for.
    move(state, drive.imu_at((i + 0.5) * dt), earth_effects(plane, state.position), dt);
  }
  EXPECT_LT((state.position - drive.position_at(20.0)).head<2>().norm(), 0.02);
  EXPECT_LT((state.velocity - drive.velocity_at(20.0)).head<2>().norm(), 0.005);
  EXPECT_NEAR(std::remainder(state.yaw() - drive.heading_at(20.0), 2.0 * M_PI), 0.0, 1e-5);
}

TEST(Mechanization, TransitionIsTheDerivative) {
  const double dt = 0.01, step = 1e-5;
  const NavigationState state = some_state();
  const EarthEffects still;  // what the earth does hardly depends on the error
  const auto f = transition(state, kSample, dt);
  NavigationState base = state;
  move(base, kSample, still, dt);
  for (int i = 0; i < kMoving; ++i) {
    NavigationState other = moved_by(state, i, step);
    move(other, kSample, still, dt);
    Eigen::Matrix<double, kMoving, 1> column;
    column << (other.position - base.position) / step, (other.velocity - base.velocity) / step,
        Eigen::Vector3d::Zero(), (other.gyro_bias - base.gyro_bias) / step,
        (other.accel_bias - base.accel_bias) / step;
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(base.attitude.transpose() * other.attitude));
    column.segment<3>(kAttitude) = turn.angle() * turn.axis() / step;
    EXPECT_LT((column - f.col(i)).norm(), 1e-3) << "column " << i;
  }
}

TEST(Mechanization, BlocksMakeTheFullProduct) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  ErrorCovariance root;
  for (int i = 0; i < kCount * kCount; ++i) root.data()[i] = normal(random);
  const ErrorCovariance p = root * root.transpose();
  ErrorCovariance blocks = p;
  predict_covariance(blocks, some_state(), kSample, ImuNoise{0.0, 0.0, 0.0, 0.0}, 0.01);
  ErrorCovariance f = ErrorCovariance::Identity();
  f.topLeftCorner<kMoving, kMoving>() = transition(some_state(), kSample, 0.01);
  EXPECT_LT((blocks - f * p * f.transpose()).norm(), 1e-11 * p.norm());
}

TEST(Mechanization, CovarianceDoesNotDependOnTheRate) {
  const auto after = [](double rate) {
    ErrorCovariance p = ErrorCovariance::Identity() * 1e-4;
    NavigationState state = some_state();
    for (int i = 0; i < static_cast<int>(10.0 * rate); ++i) {
      predict_covariance(p, state, kSample, ImuNoise(), 1.0 / rate);
      move(state, kSample, EarthEffects(), 1.0 / rate);
    }
    return p;
  };
  const ErrorCovariance reference = after(400.0);
  for (const double rate : {50.0, 100.0}) {
    const ErrorCovariance p = after(rate);
    for (int i = 0; i < kMoving; ++i)
      EXPECT_NEAR(p(i, i) / reference(i, i), 1.0, 0.01) << rate << " Hz, state " << i;
  }
}

/// The Jacobian against differences of the innovation, which falls as the state grows.
template <int Rows>
void expect_derivative(
    const std::function<Observation<Rows>(const NavigationState&, const Motion&)>& observe) {
  const double step = 1e-6;
  const NavigationState state = some_state();
  const Observation<Rows> base = observe(state, kMotion);
  for (int i = 0; i < kCount; ++i) {
    Motion motion = kMotion;
    if (i >= kGyroBias && i < kGyroBias + 3) motion.rate(i - kGyroBias) -= step;  // rate is without its bias
    const Observation<Rows> other = observe(moved_by(state, i, step), motion);
    const Eigen::Matrix<double, Rows, 1> column = (base.innovation - other.innovation) / step;
    EXPECT_LT((column - base.jacobian.col(i)).norm(), 1e-4) << "column " << i;
  }
}

TEST(Observations, PositionIsLinearized) {
  expect_derivative<3>([](const NavigationState& state, const Motion& motion) {
    return observe_position(state, motion, kLever, {1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity());
  });
}

TEST(Observations, HeadingIsLinearized) {
  expect_derivative<1>(
      [](const NavigationState& state, const Motion&) { return observe_heading(state, -3.0, 0.1); });
}

TEST(Observations, WheelsAreLinearized) {
  expect_derivative<1>([](const NavigationState& state, const Motion& motion) {
    return observe_wheel_speed(state, motion, kLever, 9.0, 0.1);
  });
}

TEST(Observations, RollingIsLinearized) {
  expect_derivative<2>([](const NavigationState& state, const Motion& motion) {
    return observe_rolling(state, motion, kLever, 0.3, 0.2);
  });
}

TEST(Observations, VelocityIsLinearizedButForTheClocks) {
  const NavigationState state = some_state();
  const auto observe = [](const NavigationState& at, const Motion& motion) {
    return observe_velocity(at, motion, kLever, {1.0, 2.0, 3.0}, Eigen::Matrix3d::Identity());
  };
  const Observation<3> base = observe(state, kMotion);
  for (int i = 0; i < kStampOffset; ++i) {
    Motion motion = kMotion;
    if (i >= kGyroBias && i < kGyroBias + 3) motion.rate(i - kGyroBias) -= 1e-6;
    const Eigen::Vector3d column =
        (base.innovation - observe(moved_by(state, i, 1e-6), motion).innovation) / 1e-6;
    EXPECT_LT((column - base.jacobian.col(i)).norm(), 1e-4) << "column " << i;
  }
  EXPECT_TRUE(base.jacobian.col(kStampOffset).isZero());
}

}  // namespace
}  // namespace relative_map::core
