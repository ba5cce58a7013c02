#pragma once

#include <algorithm>

namespace relative_map::core {

struct SmoothStep {
  double value;  ///< from 0 to 1
  double slope;
};

/// From 0 at t = 0 to 1 at t = 1, with no slope and no curvature at the ends.
inline SmoothStep smooth_step(double t) {
  t = std::clamp(t, 0.0, 1.0);
  return {t * t * t * (10.0 - t * (15.0 - 6.0 * t)), 30.0 * t * t * (1.0 - t) * (1.0 - t)};
}

}  // namespace relative_map::core
