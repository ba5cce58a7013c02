#include "relative_map/simulation/random_process.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

namespace {

constexpr int kSines = 40;  // enough for a sum that is all but normally distributed

}  // namespace

std::mt19937_64 random_engine(std::uint64_t seed, std::uint32_t stream) {
  std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), stream};
  return std::mt19937_64(sequence);
}

double OrnsteinUhlenbeck::at(double time) {
  const double kept = std::exp(-std::max(0.0, time - time_) / time_constant_);  // 0 at first
  time_ = std::max(time, time_);
  value_ = kept * value_ + noise_.draw(std::sqrt(1.0 - kept * kept));
  return standard_deviation_ * value_;
}

SmoothRandom::SmoothRandom(double standard_deviation, double length, double period, std::uint64_t seed,
                           std::uint32_t stream)
    : amplitude_(standard_deviation * std::sqrt(2.0 / kSines)) {
  std::mt19937_64 engine = random_engine(seed, stream);
  std::normal_distribution<double> frequency(0.0, 1.0 / length);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * kPi);
  for (int i = 0; i < kSines; ++i) {
    Sine sine{frequency(engine), phase(engine)};
    const double whole_waves = std::round(sine.frequency * period / (2.0 * kPi));
    if (period > 0.0) sine.frequency = 2.0 * kPi * whole_waves / period;
    sines_.push_back(sine);
  }
}

double SmoothRandom::at(double s) const {
  double sum = 0.0;
  for (const Sine& sine : sines_) sum += std::sin(sine.frequency * s + sine.phase);
  return amplitude_ * sum;
}

Episodes::Episodes(const EpisodeParam& param, std::uint64_t seed, std::uint32_t stream)
    : param_(param), engine_(random_engine(seed, stream)) {
  draw(0.0);
}

void Episodes::draw(double from) {
  if (!(param_.interval > 0.0)) return;
  std::exponential_distribution<double> pause(1.0 / param_.interval);
  std::uniform_real_distribution<double> duration(param_.min_duration, param_.max_duration), size(-1.0, 1.0);
  std::discrete_distribution<int> sides({0.4, 0.4, 0.2});
  episode_.start = from + pause(engine_);
  episode_.end = episode_.start + duration(engine_);
  const int side = sides(engine_);
  episode_.left = side != 1;
  episode_.right = side != 0;
  episode_.size = size(engine_);
}

const Episode* Episodes::at(double time) {
  if (!(param_.interval > 0.0)) return nullptr;
  while (time >= episode_.end) draw(episode_.end);
  return time >= episode_.start ? &episode_ : nullptr;
}

}  // namespace relative_map::core
