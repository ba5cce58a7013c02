#include "relative_map/simulation/wander.hpp"

#include <cmath>
#include <random>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

Wander::Wander(double amplitude, double wavelength, std::uint64_t seed) {
  std::mt19937_64 engine(seed);
  std::uniform_real_distribution<double> phase(0.0, 2.0 * kPi);
  // Wavelengths in no simple ratio, so that the sway does not repeat within a drive.
  const std::array<double, 3> shares = {0.5, 0.3, 0.2}, ratios = {1.0, 0.63, 0.41};
  for (std::size_t i = 0; i < sines_.size(); ++i) {
    sines_[i] = {shares[i] * amplitude, 2.0 * kPi / (ratios[i] * wavelength), phase(engine)};
  }
}

Wander::Sway Wander::at(double distance) const {
  Sway sway;
  for (const Sine& sine : sines_) {
    const double angle = sine.frequency * distance + sine.phase;
    sway.offset += sine.amplitude * std::sin(angle);
    sway.slope += sine.amplitude * sine.frequency * std::cos(angle);
  }
  return sway;
}

}  // namespace relative_map::core
