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
      heading_(param.heading_bias, param.heading_bias_time, NoiseSource(seed, 12)),
      jumps_(param.jump, seed, 14),
      jump_engine_(random_engine(seed, 15)) {
  std::mt19937_64 engine = random_engine(seed, 13);
  std::uniform_real_distribution<double> angle(-kPi, kPi), share(-1.0, 1.0);
  const double direction = angle(engine);
  drift_direction_ = {std::cos(direction), std::sin(direction)};
  drift_phase_ = angle(engine);
  yaw_rate_bias_ = param.yaw_rate_bias * share(engine);
  yaw_rate_scale_ = 1.0 + param.yaw_rate_scale * share(engine);
}

/// Grows evenly but for a slow sway, from 0 on, and then stays.
Point2 LocalizationErrors::drift(double time) const {
  const double t = std::clamp(time / param_.drift_time, 0.0, 1.0);
  const double sway = std::sin(2.0 * kPi * t / kSwayPeriod + drift_phase_) - std::sin(drift_phase_);
  return param_.drift * (t + kSwayShare * sway) * drift_direction_;
}

Point2 LocalizationErrors::position_bias(double time) {
  const double x = bias_x_.at(time), y = bias_y_.at(time);
  return drift(time) + jump(time) + Point2(x, y);
}

Point2 LocalizationErrors::jump(double time) {
  const Episode* episode = jumps_.at(time);
  if (episode == nullptr) return Point2::Zero();
  if (episode->start != jump_start_) {
    const double angle = std::uniform_real_distribution<double>(-kPi, kPi)(jump_engine_);
    jump_direction_ = {std::cos(angle), std::sin(angle)};
    jump_start_ = episode->start;
  }
  return (param_.min_jump + std::abs(episode->size) * (param_.max_jump - param_.min_jump)) * jump_direction_;
}

double LocalizationErrors::heading_bias(double time) {
  return heading_.at(time);
}

PoseDrift::PoseDrift(const PoseDriftParam& param, double speed_scale, double yaw_rate_scale,
                     double yaw_rate_bias, std::uint64_t seed)
    : param_(param), walk_(seed, 17), closures_(random_engine(seed, 18)) {
  NoiseSource scales(seed, 16);
  distance_scale_ += scales.draw(param.distance_scale);
  turn_scale_ += scales.draw(param.turn_scale);
  if (!param.dead_reckoned) return;
  distance_scale_ *= speed_scale;
  turn_scale_ *= yaw_rate_scale;
  yaw_rate_bias_ = yaw_rate_bias;
}

Pose2 PoseDrift::at(const Pose2& truth, double time) {
  if (param_.closed_after > 0.0 && time >= next_closure_) {
    restart();
    next_closure_ = time + std::exponential_distribution<double>(1.0 / param_.closed_after)(closures_);
  }
  if (!last_) last_ = Last{truth, truth, time};
  const Point2 moved = distance_scale_ * last_->truth.to_local(truth.position());
  const double turned = turn_scale_ * angle_difference(truth.heading(), last_->truth.heading()) +
                        yaw_rate_bias_ * (time - last_->time) +
                        walk_.draw(param_.heading_walk * std::sqrt(moved.norm()));
  const Pose2 seeming(last_->seeming.to_parent(moved), normalize_angle(last_->seeming.heading() + turned));
  last_ = Last{truth, seeming, time};
  return seeming;
}

}  // namespace relative_map::core
