#include "relative_map/pipeline/estimation/localization_noise.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kListenTime = 2.0;  // [s] over which white noise is measured
constexpr double kSteadyTime = 5.0;  // [s] over which what is steady is told from it
constexpr double kOutlier = 3.0;     // standard deviations of a step, beyond which it counts as that many
constexpr double kStep = 2.0;        // [s] between two looks at the bias
constexpr double kWalkSteps = 15.0;  // such looks that the walk is averaged over
constexpr double kLeastWalk = 0.02, kMostWalk = 0.6;  // [m/sqrt(s)]
constexpr double kBiasNoise = 0.05;                   // [m] of one look
constexpr double kMostNoise = 1.5;                    // [m] white

double squared(double value) {
  return value * value;
}

}  // namespace

LocalizationNoiseMeter::LocalizationNoiseMeter(const LocalizationNoise& expected)
    : expected_(expected),
      position_variance_(squared(2.0 * expected.least_position_noise)),
      heading_variance_(squared(2.0 * expected.least_heading_noise)),
      walk_variance_(squared(expected.position_walk)) {}

void LocalizationNoiseMeter::listen(const VehicleState& from, const VehicleState& to) {
  const double dt = to_seconds(to.stamp - from.stamp);
  if (!(dt > 0.0) || dt > 1.0) return;
  const Pose2 step = carried_on(from, dt).to_local(to.map_from_base);
  Eigen::Vector3d error(step.position().x(), step.position().y(), step.heading());
  if (!error.allFinite()) return;
  const Eigen::Vector3d white = error - steady_ * dt;
  // Two poses of equal noise make a step. A jump is no noise: it counts as an outlier only.
  const double share = std::min(0.5, dt / kListenTime);
  const auto clipped = [](double value, double limit) { return std::min(std::abs(value), limit); };
  const double place =
      clipped(white.head<2>().norm() / std::sqrt(2.0), kOutlier * std::sqrt(2.0 * position_variance_) + 0.01);
  const double turn = clipped(white[2], kOutlier * std::sqrt(2.0 * heading_variance_) + 0.001);
  position_variance_ += share * (0.5 * place * place - position_variance_);
  heading_variance_ += share * (0.5 * turn * turn - heading_variance_);
  position_variance_ = std::min(position_variance_, squared(kMostNoise));
  const double slow = std::min(0.5, dt / kSteadyTime);
  const double most = kOutlier * std::sqrt(2.0 * position_variance_) + 0.01;
  if (white.head<2>().norm() < most) steady_ += slow * (error / dt - steady_);
}

void LocalizationNoiseMeter::see_bias(Time stamp, const Point2& normal, const Point2& bias, double stddev) {
  const double dt = to_seconds(stamp - bias_stamp_);
  if (known_bias_ && dt < kStep) return;
  if (known_bias_ && dt < 3.0 * kStep) {
    const double moved = normal.dot(bias - bias_);
    const double variance = std::max(0.0, squared(moved) - squared(kBiasNoise)) / dt;
    walk_variance_ +=
        (std::min(variance, 9.0 * walk_variance_ + squared(0.05)) - walk_variance_) / kWalkSteps;
    walk_variance_ = std::clamp(walk_variance_, squared(kLeastWalk), squared(kMostWalk));
  }
  known_bias_ = true;
  bias_stamp_ = stamp;
  bias_ = bias;
  bias_stddev_ = stddev;
}

double LocalizationNoiseMeter::position_stddev() const {
  return std::max(expected_.least_position_noise, std::sqrt(position_variance_));
}

double LocalizationNoiseMeter::heading_stddev() const {
  return std::max(expected_.least_heading_noise, std::sqrt(heading_variance_));
}

double LocalizationNoiseMeter::position_walk() const {
  return std::sqrt(walk_variance_);
}

}  // namespace relative_map::core
