#pragma once

#include <cmath>

namespace relative_map::core {

/// y(x) = c0 + c1 x + c2 x^2 + c3 x^3, all in [m].
struct Cubic {
  double c0 = 0.0, c1 = 0.0, c2 = 0.0, c3 = 0.0;

  double value(double x) const { return c0 + x * (c1 + x * (c2 + x * c3)); }
  double slope(double x) const { return c1 + x * (2.0 * c2 + x * 3.0 * c3); }
  double second_derivative(double x) const { return 2.0 * c2 + 6.0 * c3 * x; }
  /// [1/m] y'' / (1 + y'^2)^(3/2)
  double kappa(double x) const {
    const double q = 1.0 + slope(x) * slope(x);
    return second_derivative(x) / (q * std::sqrt(q));
  }
};

}  // namespace relative_map::core
