#include "relative_map/simulation/localization_errors.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kSwayShare = 0.1;   // of the drift: it goes unevenly
constexpr double kSwayPeriod = 0.4;  // of the time that the drift takes

}  // namespace

LocalizationErrors::LocalizationErrors(const LocalizationErrorParam& param, std::uint64_t seed)
    : param_(param),
      bias_x_(param.bias, param.bias_time, NoiseSource(seed, 10)),
      bias_y_(param.bias, param.bias_time, NoiseSource(seed, 11)),
      heading_(param.heading_bias, param.heading_bias_time, NoiseSource(seed, 12)) {
  std::mt19937_64 engine = random_engine(seed, 13);
  std::uniform_real_distribution<double> angle(-kPi, kPi), share(-1.0, 1.0);
  const double direction = angle(engine);
  drift_direction_ = {std::cos(direction), std::sin(direction)};
  drift_phase_ = angle(engine);
  yaw_rate_bias_ = param.yaw_rate_bias * share(engine);
}

/// Grows evenly but for a slow sway, from 0 on, and then stays.
Point2 LocalizationErrors::drift(double time) const {
  const double t = std::clamp(time / param_.drift_time, 0.0, 1.0);
  const double sway = std::sin(2.0 * kPi * t / kSwayPeriod + drift_phase_) - std::sin(drift_phase_);
  return param_.drift * (t + kSwayShare * sway) * drift_direction_;
}

Point2 LocalizationErrors::position_bias(double time) {
  const double x = bias_x_.at(time), y = bias_y_.at(time);
  return drift(time) + Point2(x, y);
}

double LocalizationErrors::heading_bias(double time) {
  return heading_.at(time);
}

}  // namespace relative_map::core
