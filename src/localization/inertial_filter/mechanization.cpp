#include "relative_map/localization/inertial_filter/mechanization.hpp"

#include <cmath>

#include "relative_map/localization/geodesy/earth.hpp"

namespace relative_map::core {

namespace {

constexpr double kEarthRadius = 6.371e6;  // [m] mean; gravity's direction needs no more than that

/// The blocks of F - I and of F that are not zero (Sola, Quaternion kinematics for the error-state Kalman
/// filter, 2017, 7.2; position to second order).
struct Blocks {
  double dt;
  Eigen::Matrix3d velocity_attitude, velocity_accel_bias, attitude_attitude;

  Blocks(const NavigationState& before, const ImuSample& mean, double step) : dt(step) {
    velocity_attitude = -before.attitude * cross_matrix(mean.specific_force - before.accel_bias) * step;
    velocity_accel_bias = -before.attitude * step;
    attitude_attitude = rotation_by((before.gyro_bias - mean.angular_velocity) * step);
  }
};

}  // namespace

EarthEffects earth_effects(const TangentPlane& plane, const Eigen::Vector3d& position) {
  const double latitude = plane.origin().latitude * M_PI / 180.0;
  const Eigen::Vector3d up =
      Eigen::Vector3d(position.x(), position.y(), kEarthRadius + position.z()).normalized();
  const double height = plane.origin().altitude + position.z();
  // The plane is left behind 5 km from its origin: gravity differs by less than 1e-4 m/s^2 on it.
  return {-normal_gravity(latitude + position.y() / kEarthRadius, height) * up, earth_rate_enu(latitude)};
}

Eigen::Vector3d move(NavigationState& state, const ImuSample& mean, const EarthEffects& earth, double dt) {
  const Eigen::Vector3d rate =
      mean.angular_velocity - state.gyro_bias - state.attitude.transpose() * earth.rate;
  const Eigen::Matrix3d half_turn = rotation_by(0.5 * dt * rate);
  const Eigen::Matrix3d middle = state.attitude * half_turn;
  const Eigen::Vector3d acceleration = middle * (mean.specific_force - state.accel_bias) + earth.gravity -
                                       2.0 * earth.rate.cross(state.velocity);
  state.position += state.velocity * dt + 0.5 * dt * dt * acceleration;
  state.velocity += acceleration * dt;
  // Back to a rotation: one step of Newton's iteration, exact to the square of what was lost.
  const Eigen::Matrix3d turned = middle * half_turn;
  state.attitude = 0.5 * turned * (3.0 * Eigen::Matrix3d::Identity() - turned.transpose() * turned);
  return acceleration;
}

Eigen::Matrix<double, error::kMoving, error::kMoving> transition(const NavigationState& before,
                                                                 const ImuSample& mean, double dt) {
  using namespace error;
  const Blocks blocks(before, mean, dt);
  Eigen::Matrix<double, kMoving, kMoving> f = Eigen::Matrix<double, kMoving, kMoving>::Identity();
  f.block<3, 3>(kPosition, kVelocity) = Eigen::Matrix3d::Identity() * dt;
  f.block<3, 3>(kPosition, kAttitude) = 0.5 * dt * blocks.velocity_attitude;
  f.block<3, 3>(kPosition, kAccelBias) = 0.5 * dt * blocks.velocity_accel_bias;
  f.block<3, 3>(kVelocity, kAttitude) = blocks.velocity_attitude;
  f.block<3, 3>(kVelocity, kAccelBias) = blocks.velocity_accel_bias;
  f.block<3, 3>(kAttitude, kAttitude) = blocks.attitude_attitude;
  f.block<3, 3>(kAttitude, kGyroBias) = -Eigen::Matrix3d::Identity() * dt;
  return f;
}

void predict_covariance(ErrorCovariance& p, const NavigationState& before, const ImuSample& mean,
                        const ImuNoise& noise, double dt) {
  using namespace error;
  const Blocks blocks(before, mean, dt);
  // F P, rows that change: first position, which needs the other rows as they were.
  const Eigen::Matrix<double, 3, kCount> gained =
      blocks.velocity_attitude.lazyProduct(p.middleRows<3>(kAttitude)) +
      blocks.velocity_accel_bias.lazyProduct(p.middleRows<3>(kAccelBias));
  p.middleRows<3>(kPosition) += dt * p.middleRows<3>(kVelocity) + 0.5 * dt * gained;
  p.middleRows<3>(kVelocity) += gained;
  p.middleRows<3>(kAttitude) =
      (blocks.attitude_attitude.lazyProduct(p.middleRows<3>(kAttitude)) - dt * p.middleRows<3>(kGyroBias))
          .eval();
  // (F P) F', columns likewise.
  const Eigen::Matrix<double, kCount, 3> gained_columns =
      p.middleCols<3>(kAttitude).lazyProduct(blocks.velocity_attitude.transpose()) +
      p.middleCols<3>(kAccelBias).lazyProduct(blocks.velocity_accel_bias.transpose());
  p.middleCols<3>(kPosition) += dt * p.middleCols<3>(kVelocity) + 0.5 * dt * gained_columns;
  p.middleCols<3>(kVelocity) += gained_columns;
  p.middleCols<3>(kAttitude) = (p.middleCols<3>(kAttitude).lazyProduct(blocks.attitude_attitude.transpose()) -
                                dt * p.middleCols<3>(kGyroBias))
                                   .eval();
  const double velocity = noise.accel_noise * noise.accel_noise * dt;
  const double attitude = noise.gyro_noise * noise.gyro_noise * dt;
  for (int i = 0; i < 3; ++i) {
    p(kPosition + i, kPosition + i) += velocity * dt * dt / 3.0;
    p(kPosition + i, kVelocity + i) += velocity * dt / 2.0;
    p(kVelocity + i, kPosition + i) += velocity * dt / 2.0;
    p(kVelocity + i, kVelocity + i) += velocity;
    p(kAttitude + i, kAttitude + i) += attitude;
    p(kGyroBias + i, kGyroBias + i) += noise.gyro_bias_walk * noise.gyro_bias_walk * dt;
    p(kAccelBias + i, kAccelBias + i) += noise.accel_bias_walk * noise.accel_bias_walk * dt;
  }
}

}  // namespace relative_map::core
