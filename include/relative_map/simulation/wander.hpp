#pragma once

#include <array>
#include <cstdint>

namespace relative_map::core {

/// How a driver sways in the lane: a smooth lateral offset by distance driven, a sum of slow sines whose
/// phases come from the seed. By distance, not time, so that a standing vehicle stands still.
class Wander {
 public:
  /// The offset stays within `amplitude` [m]; `wavelength` [m] is the longest sine's. Both may not be
  /// negative, and `wavelength` not 0.
  Wander(double amplitude, double wavelength, std::uint64_t seed);

  struct Sway {
    double offset = 0.0;  ///< [m] left positive
    double slope = 0.0;   ///< [-] by distance
  };
  Sway at(double distance) const;

 private:
  struct Sine {
    double amplitude;  ///< [m]
    double frequency;  ///< [rad/m]
    double phase;      ///< [rad]
  };
  std::array<Sine, 3> sines_;
};

}  // namespace relative_map::core
