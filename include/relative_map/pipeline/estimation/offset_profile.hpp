#pragma once

#include <Eigen/Core>

namespace relative_map::core {

/// The lateral offset of a lane from its recorded line, by s: a cubic B-spline over evenly spaced knots, so
/// that heading and curvature are smooth. What it may be is a Gaussian process (Matern 3/2): alike over tens
/// of metres, and as large as the `sway` [m] that is given.
class OffsetProfile {
 public:
  static constexpr int kKnots = 8;
  static constexpr double kSpacing = 12.0;  ///< [m] between knots
  using Knots = Eigen::Matrix<double, kKnots, 1>;
  using Covariance = Eigen::Matrix<double, kKnots, kKnots>;

  /// Of knots of which nothing was seen yet [m^2].
  static Covariance prior(double sway);
  /// Share of each knot in the offset at `place`, in knots from the first one; past the ends the process
  /// goes on by itself and fades to zero.
  static Eigen::Matrix<double, 1, kKnots> shares(double place);
  /// A knot beyond the end of two others (`near` the end one): its expectation, and its variance [m^2].
  struct Next {
    double from_near, from_far;  ///< shares of the two
    double variance;
  };
  static Next next(double sway);

  explicit OffsetProfile(const Knots& knots);
  /// [m] left positive, at `place` in knots from the first one.
  double at(double place) const;

 private:
  static constexpr int kBeyond = 12;  ///< knots past an end that are not zero yet
  static constexpr int kFirst = -kBeyond - 2, kPieces = kKnots + 2 * kBeyond + 3;  ///< between knots

  Eigen::Matrix<double, 4, kPieces> pieces_;  ///< a cubic each, by the place past its knot
};

}  // namespace relative_map::core
