#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace relative_map::core {

/// How the two half widths of a lane (left, right) change along it: both together slowly, and apart hardly at
/// all, since a lane's center is the middle between its paint.
struct HalfWidthModel {
  static constexpr double kUnknown = 0.25;      ///< [m] standard deviation of both, where nothing was seen
  static constexpr double kApart = 0.015;       ///< [m] of each from the mean of both
  static constexpr double kWalk = 0.006;        ///< [m] of both, by the root of the way [m]
  static constexpr double kApartLength = 20.0;  ///< [m] over which a difference is forgotten

  /// [m^2] of the sum's and of the difference's share.
  static Eigen::Matrix2d covariance(double together, double apart) {
    Eigen::Matrix2d result;
    result << together + apart, together - apart, together - apart, together + apart;
    return result;
  }
  static Eigen::Matrix2d unknown() { return covariance(kUnknown * kUnknown, kApart * kApart); }
  /// Over `way` [m].
  static Eigen::Matrix2d transition(double way) {
    const double kept = std::exp(-way / kApartLength);
    return covariance(0.5, 0.5 * kept);
  }
  static Eigen::Matrix2d noise(double way) {
    const double kept = std::exp(-way / kApartLength);
    return covariance(kWalk * kWalk * way, kApart * kApart * (1.0 - kept * kept));
  }
};

}  // namespace relative_map::core
