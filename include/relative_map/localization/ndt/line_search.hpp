#pragma once

#include <functional>

namespace relative_map::core {

/// A function of a step's length, and its slope there.
struct Slope {
  double value = 0.0, slope = 0.0;
};

struct LineSearchParam {
  double decrease = 1e-4;  ///< mu: the least share of the decrease that the slope at 0 promises
  double curvature = 0.9;  ///< nu: the largest share of that slope that may be left
  int trials = 10;         ///< at most
};

struct LineSearchResult {
  double length = 0.0;  ///< the step to take; 0: none lowers the function
  int trials = 0;
  bool satisfied = false;  ///< both conditions hold at `length`
};

/// A length in [0, `longest`] of sufficient decrease and small slope, beginning with `first` (Moré and
/// Thuente, ACM TOMS 20, 1994, with their names for the cases). `at_zero.slope` must be negative. The last
/// call of `function` is always at the length that is returned, if that is not 0.
LineSearchResult line_search(const std::function<Slope(double)>& function, const Slope& at_zero, double first,
                             double longest, const LineSearchParam& param = {});

}  // namespace relative_map::core
