#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/error_param.hpp"
#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

/// Standard deviations of a cubic's coefficients.
struct CubicNoise {
  double c0 = 0.0;  ///< [m]
  double c1 = 0.0;  ///< [-]
  double c2 = 0.0;  ///< [1/m]
  double c3 = 0.0;  ///< [1/m^2]
};

/// How a camera gets lane markers wrong.
class MarkerErrors {
 public:
  MarkerErrors(const MarkerErrorParam& param, const CubicNoise& noise, std::uint64_t seed);

  /// [m] how far it sees at a time [s] that never falls, where it sees `view_range` [m] on average.
  double view_range(double view_range, double time);
  /// Spoils the markers of an image taken at `time` [s], which never falls.
  void spoil(LaneMarkers& markers, double time);
  /// [s] from the next image to its message.
  double draw_latency();

 private:
  /// Of one coefficient of one marker.
  struct Noise {
    NoiseSource white;
    OrnsteinUhlenbeck lasting;
    double white_size;
  };
  Cubic draw_noise(std::size_t role, double time);

  MarkerErrorParam param_;
  std::vector<Noise> noises_;  ///< four of each role: left, right, next left, next right, and the image
  OrnsteinUhlenbeck view_range_change_;
  Episodes dropouts_, outliers_, blind_;
  std::mt19937_64 latency_;
};

}  // namespace relative_map::core
