#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// What a filter has come to think of one of its sources.
struct SourceHealth {
  Time last{};  ///< stamp of the newest measurement
  std::uint64_t accepted = 0, refused = 0;
  int refused_in_row = 0;
  Time first_refusal{};                                          ///< of those in a row
  Eigen::Vector3d refused_innovation = Eigen::Vector3d::Zero();  ///< the last one's
  bool refusals_agree = true;                                    ///< those in a row say the same
  double nis = 1.0;          ///< [-] mean of the squared innovation by its covariance, by degrees of freedom
  double noise_scale = 1.0;  ///< [-] that the source's own covariance is multiplied by: it was out by as much
  double distrust = 0.0;     ///< [m^2] more, after it has jumped; fades
  Time last_used{};          ///< stamp of the newest one that was used
  double systematic = 0.0;   ///< [m^2] of a source of positions: what no filtering takes out

  bool heard() const { return accepted + refused > 0; }
};

/// Squared distances by degrees of freedom (1 to 3) that a right measurement exceeds with this probability:
/// the chi-square distribution's.
std::array<double, 4> chi_square_gates(double probability);

/// Takes note of an innovation's squared distance: a source that is further off than it says is believed
/// less, and more again when it is not.
void note_innovation(SourceHealth& health, double squared_distance, int rows, double most = 400.0);

/// Errors of a position that is no fixed RTK solution change slowly: what the noise of one at `time` is
/// multiplied by, so that all of 0.3 s count as one.
double correlation_factor(const SourceHealth& health, Time time, bool fixed);
/// Takes note of one that was used, with a standard deviation of `stddev` [m]: half of it stays for minutes.
void note_used(SourceHealth& health, Time time, double stddev, bool fixed);

/// What the noise of an unlikely measurement is multiplied by, so that it counts in proportion to its
/// distance instead of the square (Huber 1964); 1 for a likely one.
double huber_factor(double squared_distance, int rows);

}  // namespace relative_map::core
