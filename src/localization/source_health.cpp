#include "relative_map/localization/source_health.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

void note_innovation(SourceHealth& health, double squared_distance, int rows, double most) {
  if (!std::isfinite(squared_distance)) return;
  constexpr double kMemory = 0.05;  // [-] of the mean that one innovation makes
  constexpr double kUsual = 1.5;    // [-] above it, noise is believed to be more than was said
  constexpr double kGain = 0.05, kFall = 0.97, kRise = 1.3;  // [-]
  const double normalized = squared_distance / rows;
  health.nis += kMemory * (std::min(normalized, 10.0) - health.nis);
  const double factor = std::clamp(1.0 + kGain * (std::min(normalized, 9.0) - kUsual), kFall, kRise);
  health.noise_scale = std::clamp(health.noise_scale * factor, 1.0, most);
}

double correlation_factor(const SourceHealth& health, Time time, bool fixed) {
  constexpr double kAlike = 0.3;       // [s] for which errors are about the same
  constexpr double kMostOften = 0.05;  // [s] between fixes
  if (fixed) return 1.0;
  const double apart = std::max(kMostOften, to_seconds(time - health.last_used));
  return std::max(1.0, kAlike / apart);
}

void note_used(SourceHealth& health, Time time, double stddev, bool fixed) {
  constexpr double kStays =
      0.5;  // [-] of the error: the ionosphere's and the orbits' share, and walls nearby
  constexpr double kMemory = 0.2;  // [-] of the mean that one fix makes
  const double now = fixed ? 0.0 : kStays * kStays * stddev * stddev;
  health.systematic += (health.last_used == Time() ? 1.0 : kMemory) * (now - health.systematic);
  health.last_used = time;
}

double huber_factor(double squared_distance, int rows) {
  constexpr double kLikely = 2.5;  // [-] standard deviations of all rows together
  return std::max(1.0, std::sqrt(squared_distance / rows) / kLikely);
}

}  // namespace relative_map::core
