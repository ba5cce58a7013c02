#pragma once

#include <cmath>

namespace relative_map::core {

constexpr double kPi = 3.14159265358979323846;

/// The same direction in (-pi, pi]. Not finite in, not finite out.
inline double normalize_angle(double angle) {
  if (angle > -kPi && angle <= kPi) return angle;  // nearly always
  const double wrapped = std::remainder(angle, 2.0 * kPi);
  return wrapped <= -kPi ? kPi : wrapped;
}

/// a - b the short way round, in (-pi, pi].
inline double angle_difference(double a, double b) {
  return normalize_angle(a - b);
}

/// The direction `weight` of the way from a to b, the short way round.
inline double interpolate_angle(double a, double b, double weight) {
  return normalize_angle(a + weight * angle_difference(b, a));
}

}  // namespace relative_map::core
