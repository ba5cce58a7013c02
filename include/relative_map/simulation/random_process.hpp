#pragma once

#include <cstdint>
#include <limits>
#include <random>
#include <vector>

#include "relative_map/simulation/error_param.hpp"
#include "relative_map/simulation/noise.hpp"

namespace relative_map::core {

/// An Ornstein-Uhlenbeck process: normally distributed at any time, and forgotten over `time_constant`.
class OrnsteinUhlenbeck {
 public:
  /// `time_constant` > 0, in the unit of at()'s argument.
  OrnsteinUhlenbeck(double standard_deviation, double time_constant, const NoiseSource& noise)
      : standard_deviation_(standard_deviation), time_constant_(time_constant), noise_(noise) {}

  /// At times that never fall.
  double at(double time);

 private:
  double standard_deviation_, time_constant_;
  NoiseSource noise_;
  double value_ = 0.0;  ///< of standard deviation 1
  double time_ = -std::numeric_limits<double>::infinity();
};

/// A smooth random function of a place, normally distributed, with a correlation of exp(-d^2 / (2 length^2)).
class SmoothRandom {
 public:
  /// `period` [m] > 0: it repeats after that, as along a lap; 0: it does not.
  SmoothRandom(double standard_deviation, double length, double period, std::uint64_t seed,
               std::uint32_t stream);

  double at(double s) const;

 private:
  struct Sine {
    double frequency, phase;
  };
  double amplitude_;
  std::vector<Sine> sines_;
};

/// A fault that comes and goes, on the left or on the right or on both sides.
struct Episode {
  double start, end;  ///< [s]
  bool left, right;
  double size;  ///< in [-1, 1], uniform
};

class Episodes {
 public:
  Episodes(const EpisodeParam& param, std::uint64_t seed, std::uint32_t stream);

  /// The one that is going on; null: none. At times that never fall.
  const Episode* at(double time);

 private:
  void draw(double from);

  EpisodeParam param_;
  std::mt19937_64 engine_;
  Episode episode_{};
};

/// A generator of its own for each seed and stream.
std::mt19937_64 random_engine(std::uint64_t seed, std::uint32_t stream);

}  // namespace relative_map::core
