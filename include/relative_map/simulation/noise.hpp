#pragma once

#include <cstdint>
#include <random>

namespace relative_map::core {

/// Gaussian noise of one sensor, the same for the same seed, whatever the other sensors draw.
class NoiseSource {
 public:
  NoiseSource(std::uint64_t seed, std::uint32_t sensor) {
    std::seed_seq sequence{static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32), sensor};
    engine_.seed(sequence);
  }

  /// Uses up as many numbers for 0 as for any other value: one sensor value's noise does not shift another's.
  double draw(double standard_deviation) { return standard_deviation * normal_(engine_); }

 private:
  std::mt19937_64 engine_;
  std::normal_distribution<double> normal_;
};

}  // namespace relative_map::core
