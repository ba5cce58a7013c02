#include "relative_map/prediction/motion_filter.hpp"

#include <Eigen/LU>
#include <cmath>

namespace relative_map::core {

namespace {

using Matrix2 = Eigen::Matrix2d;

// A road user may do anything when it comes into sight: as fast as a car on a motorway, as it brakes in need.
constexpr double kFirstSpeedStddev = 15.0;        // [m/s]
constexpr double kFirstAccelerationStddev = 1.5;  // [m/s^2]
// The seed's numbers, for comparison.
constexpr double kSeedProcess = 0.01, kSeedMeasurement = 0.1, kSeedFirst = 0.1;

/// The same axis model on x and y.
MotionFilter::Covariance on_both_axes(const Eigen::Matrix3d& x, const Eigen::Matrix3d& y) {
  MotionFilter::Covariance both = MotionFilter::Covariance::Zero();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      both(2 * i, 2 * j) = x(i, j);
      both(2 * i + 1, 2 * j + 1) = y(i, j);
    }
  }
  return both;
}

}  // namespace

AccelerationModel acceleration_model(RoadUserType type, const MotionFilterParam& param) {
  switch (type) {
    case RoadUserType::kPedestrian:
      return {param.pedestrian_time, param.pedestrian_along, param.pedestrian_along};
    case RoadUserType::kBicycle:
      return {param.bicycle_time, param.bicycle_along, param.bicycle_along};
    default:
      return {param.acceleration_time, param.vehicle_along, param.vehicle_across};
  }
}

Eigen::Matrix3d singer_transition(double dt, double time) {
  const double x = dt / time, e = std::exp(-x);
  Eigen::Matrix3d f;
  f << 1.0, dt, time * time * (x - 1.0 + e),  //
      0.0, 1.0, time * (1.0 - e),             //
      0.0, 0.0, e;
  return f;
}

Eigen::Matrix3d singer_noise(double dt, double time) {
  const double x = dt / time;
  Eigen::Matrix3d q;
  if (x < 0.01) {  // the closed form loses its digits: its series, which is white jerk
    const double d2 = dt * dt, d3 = d2 * dt;
    q << d3 * d2 / 20.0, d2 * d2 / 8.0, d3 / 6.0,  //
        d2 * d2 / 8.0, d3 / 3.0, d2 / 2.0,         //
        d3 / 6.0, d2 / 2.0, dt;
    return 2.0 / time * q;
  }
  const double e = std::exp(-x), e2 = e * e, t2 = time * time;
  const double pp = t2 * t2 * (1.0 - e2 + 2.0 * x + 2.0 * x * x * x / 3.0 - 2.0 * x * x - 4.0 * x * e);
  const double pv = t2 * time * (e2 + 1.0 - 2.0 * e + 2.0 * x * e - 2.0 * x + x * x);
  const double pa = t2 * (1.0 - e2 - 2.0 * x * e);
  const double vv = t2 * (4.0 * e - 3.0 - e2 + 2.0 * x);
  const double va = time * (e2 + 1.0 - 2.0 * e);
  q << pp, pv, pa, pv, vv, va, pa, va, 1.0 - e2;
  return q;
}

MotionFilter::MotionFilter(const SeenRoadUser& seen, double position_stddev, const MotionFilterParam& param)
    : seed_(param.preset == "seed") {
  state_.segment<2>(0) = seen.position;
  const bool has_velocity = seen.velocity.allFinite();
  if (has_velocity) state_.segment<2>(2) = seen.velocity;
  const double speed_stddev = has_velocity ? 1.0 : kFirstSpeedStddev;
  covariance_.setZero();
  if (seed_) {
    covariance_.diagonal().setConstant(kSeedFirst);
    return;
  }
  covariance_.diagonal() << Point2::Constant(position_stddev * position_stddev),
      Point2::Constant(speed_stddev * speed_stddev),
      Point2::Constant(kFirstAccelerationStddev * kFirstAccelerationStddev);
}

void MotionFilter::predict(double dt, double heading, const AccelerationModel& model) {
  if (!(dt > 0.0)) return;
  Covariance transition, noise;
  if (seed_) {
    Eigen::Matrix3d f;
    f << 1.0, dt, 0.5 * dt * dt, 0.0, 1.0, dt, 0.0, 0.0, 1.0;
    transition = on_both_axes(f, f);
    noise = kSeedProcess * Covariance::Identity();
  } else {
    const Eigen::Matrix3d f = singer_transition(dt, model.time), q = singer_noise(dt, model.time);
    transition = on_both_axes(f, f);
    // Along and across, turned to the axes: what they share stands beside the diagonal.
    const double c = std::cos(heading), s = std::sin(heading);
    const double along = model.along * model.along, across = model.across * model.across;
    Matrix2 axes;
    axes << c * c * along + s * s * across, c * s * (along - across),  //
        c * s * (along - across), s * s * along + c * c * across;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) noise.block<2, 2>(2 * i, 2 * j) = q(i, j) * axes;
    }
  }
  state_ = transition * state_;
  covariance_ = transition * covariance_ * transition.transpose() + noise;
}

namespace {

/// The update of two neighbouring states that are measured as they are; Joseph's form, which stays symmetric.
template <int Row>
void update(MotionFilter::State& state, MotionFilter::Covariance& covariance, const Point2& measured,
            double variance) {
  const Matrix2 innovation = covariance.template block<2, 2>(Row, Row) + variance * Matrix2::Identity();
  const Eigen::Matrix<double, 6, 2> gain = covariance.template block<6, 2>(0, Row) * innovation.inverse();
  state += gain * (measured - state.template segment<2>(Row));
  MotionFilter::Covariance rest = MotionFilter::Covariance::Identity();
  rest.template block<6, 2>(0, Row) -= gain;
  covariance = rest * covariance * rest.transpose() + variance * gain * gain.transpose();
}

}  // namespace

void MotionFilter::update_position(const Point2& position, double stddev) {
  update<0>(state_, covariance_, position, seed_ ? kSeedMeasurement : stddev * stddev);
}

void MotionFilter::update_velocity(const Point2& velocity, double stddev) {
  update<2>(state_, covariance_, velocity, stddev * stddev);
}

double MotionFilter::surprise(const Point2& position, double stddev) const {
  const Matrix2 innovation = covariance_.block<2, 2>(0, 0) + stddev * stddev * Matrix2::Identity();
  const Point2 offset = position - this->position();
  return offset.dot(innovation.inverse() * offset);
}

double MotionFilter::speed_stddev(const Point2& direction) const {
  return std::sqrt(std::max(0.0, direction.dot(covariance_.block<2, 2>(2, 2) * direction)));
}

}  // namespace relative_map::core
