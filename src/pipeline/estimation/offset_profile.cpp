#include "relative_map/pipeline/estimation/offset_profile.hpp"

#include <Eigen/LU>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kLength = 25.0;  // [m] over which a driver changes his place in the lane

double kernel(double distance) {
  const double d = std::abs(distance) / kLength;
  return (1.0 + d) * std::exp(-d);
}

/// Whether any knot has a share at `place`; not at one that is no number.
bool has_shares(double place, int knots, int beyond) {
  return place > -beyond - 2.0 && place < knots + beyond + 2.0;
}

/// Of the uniform cubic B-spline, `distance` knots from its middle.
double basis(double distance) {
  const double d = std::abs(distance);
  if (d >= 2.0) return 0.0;
  if (d >= 1.0) return (2.0 - d) * (2.0 - d) * (2.0 - d) / 6.0;
  return 2.0 / 3.0 - d * d + 0.5 * d * d * d;
}

}  // namespace

OffsetProfile::Next OffsetProfile::next(double sway) {
  const double k0 = kernel(0.0), k1 = kernel(OffsetProfile::kSpacing),
               k2 = kernel(2.0 * OffsetProfile::kSpacing);
  Eigen::Matrix2d known;
  known << k0, k1, k1, k0;
  const Eigen::Vector2d cross(k1, k2), shares = known.inverse() * cross;
  return {shares[0], shares[1], sway * sway * (k0 - cross.dot(shares))};
}

OffsetProfile::Covariance OffsetProfile::prior(double sway) {
  Covariance covariance;
  for (int i = 0; i < kKnots; ++i) {
    for (int j = 0; j < kKnots; ++j) covariance(i, j) = sway * sway * kernel(kSpacing * (i - j));
  }
  return covariance;
}

Eigen::Matrix<double, 1, OffsetProfile::kKnots> OffsetProfile::shares(double place) {
  Eigen::Matrix<double, 1, kKnots> row = Eigen::Matrix<double, 1, kKnots>::Zero();
  if (!has_shares(place, kKnots, kBeyond)) return row;
  const int first = static_cast<int>(std::floor(place)) - 1;
  for (int knot = first; knot < first + 4; ++knot) {
    const double share = basis(place - knot);
    if (knot >= 0 && knot < kKnots) {
      row[knot] += share;
      continue;
    }
    const bool ahead = knot >= kKnots;
    const int steps = ahead ? knot - kKnots + 1 : -knot;
    if (steps > kBeyond) continue;
    const Next step = next(0.0);
    // The share of the two end knots in the one that many steps past them.
    double near = 1.0, far = 0.0;
    for (int i = 0; i < steps; ++i) {
      const double before = near;
      near = step.from_near * before + far;
      far = step.from_far * before;
    }
    row[ahead ? kKnots - 1 : 0] += share * near;
    row[ahead ? kKnots - 2 : 1] += share * far;
  }
  return row;
}

OffsetProfile::OffsetProfile(const Knots& knots) {
  constexpr int kZeros = 3, kAll = kKnots + 2 * (kBeyond + kZeros), kBegin = kZeros + kBeyond;
  Eigen::Matrix<double, kAll, 1> all = all.Zero();
  all.segment<kKnots>(kBegin) = knots;
  const Next step = next(0.0);
  for (int i = kBegin - 1; i >= kZeros; --i)
    all[i] = step.from_near * all[i + 1] + step.from_far * all[i + 2];
  for (int i = kBegin + kKnots; i < kAll - kZeros; ++i) {
    all[i] = step.from_near * all[i - 1] + step.from_far * all[i - 2];
  }
  Eigen::Matrix4d basis;        // of the uniform cubic B-spline: a row for each power
  basis << 1.0, 4.0, 1.0, 0.0,  //
      -3.0, 0.0, 3.0, 0.0,      //
      3.0, -6.0, 3.0, 0.0,      //
      -1.0, 3.0, -3.0, 1.0;
  for (int i = 0; i < kPieces; ++i) pieces_.col(i) = basis / 6.0 * all.segment<4>(i);
}

double OffsetProfile::at(double place) const {
  if (!(place >= kFirst && place < kFirst + kPieces)) return 0.0;  // NaN is nowhere either
  const double knot = std::floor(place), u = place - knot;
  const auto piece = pieces_.col(static_cast<int>(knot) - kFirst);
  return piece[0] + u * (piece[1] + u * (piece[2] + u * piece[3]));
}

}  // namespace relative_map::core
