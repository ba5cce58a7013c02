#include "relative_map/localization/ndt/line_search.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

struct Point {
  double at = 0.0, value = 0.0, slope = 0.0;
};

/// The lowest place of the cubic through two points and their slopes.
double cubic_minimum(const Point& a, const Point& b) {
  const double z = 3.0 * (a.value - b.value) / (b.at - a.at) + a.slope + b.slope;
  const double w = std::sqrt(std::max(0.0, z * z - a.slope * b.slope)) * (b.at > a.at ? 1.0 : -1.0);
  return b.at - (b.at - a.at) * (b.slope + w - z) / (b.slope - a.slope + 2.0 * w);
}

/// The lowest place of the parabola through two points and the slope at the first.
double parabola_minimum(const Point& a, const Point& b) {
  return a.at - 0.5 * (b.at - a.at) * a.slope / (a.slope - (a.value - b.value) / (a.at - b.at));
}

/// Where the line through two slopes is 0.
double secant_minimum(const Point& a, const Point& b) {
  return a.at - (a.at - b.at) / (a.slope - b.slope) * a.slope;
}

/// The interval, its better end first, and the next trial within it.
struct Interval {
  Point best, other;
  bool bracketed = false;

  /// The next trial by the four cases of section 4 of the paper; then `trial` becomes an end.
  double next(const Point& trial, double longest) {
    double at;
    const bool turned = trial.slope * best.slope < 0.0;
    bool close_to_bound = false;
    if (trial.value > best.value) {  // case 1: too far, a minimum lies between
      const double cubic = cubic_minimum(best, trial), parabola = parabola_minimum(best, trial);
      at = std::abs(cubic - best.at) < std::abs(parabola - best.at) ? cubic : 0.5 * (cubic + parabola);
      bracketed = true;
      close_to_bound = true;
    } else if (turned) {  // case 2: lower, and rising again
      const double cubic = cubic_minimum(best, trial), secant = secant_minimum(best, trial);
      at = std::abs(cubic - trial.at) >= std::abs(secant - trial.at) ? cubic : secant;
      bracketed = true;
    } else if (std::abs(trial.slope) <= std::abs(best.slope)) {  // case 3: lower, and less steep
      const double cubic = cubic_minimum(best, trial), secant = secant_minimum(best, trial);
      const bool ahead = (cubic - trial.at) * (trial.at - best.at) > 0.0 && std::isfinite(cubic);
      if (!ahead) {
        at = secant;
      } else if (bracketed) {
        at = std::abs(cubic - trial.at) < std::abs(secant - trial.at) ? cubic : secant;
      } else {
        at = std::abs(cubic - trial.at) > std::abs(secant - trial.at) ? cubic : secant;
      }
      close_to_bound = bracketed;
    } else {  // case 4: lower, and steeper still
      at = bracketed ? cubic_minimum(trial, other) : longest;
    }
    if (trial.value > best.value) {
      other = trial;
    } else {
      if (turned) other = best;
      best = trial;
    }
    if (!std::isfinite(at)) at = 0.5 * (best.at + other.at);
    if (bracketed && close_to_bound) {
      const double bound = best.at + 0.66 * (other.at - best.at);
      at = other.at > best.at ? std::min(at, bound) : std::max(at, bound);
    }
    return at;
  }
};

}  // namespace

LineSearchResult line_search(const std::function<Slope(double)>& function, const Slope& at_zero, double first,
                             double longest, const LineSearchParam& param) {
  LineSearchResult result;
  if (!(at_zero.slope < 0.0) || !(longest > 0.0)) return result;
  Interval interval;
  interval.best = interval.other = {0.0, at_zero.value, at_zero.slope};
  const double promised = param.decrease * at_zero.slope;
  bool auxiliary = true;  // search on psi until a step of sufficient decrease and rising slope is found
  double at = std::min(first, longest);
  double lowest_at = 0.0, lowest = at_zero.value, last_at = 0.0;
  while (result.trials < param.trials) {
    ++result.trials;
    const Slope now = function(at);
    last_at = at;
    if (now.value < lowest) {
      lowest = now.value;
      lowest_at = at;
    }
    const bool enough = now.value <= at_zero.value + promised * at;
    if (enough && std::abs(now.slope) <= -param.curvature * at_zero.slope) {
      result.satisfied = true;
      result.length = at;
      return result;
    }
    if (at >= longest && enough && now.slope <= promised) {  // still falling where it must end
      result.length = at;
      return result;
    }
    if (auxiliary && enough && now.slope >= 0.0) auxiliary = false;
    // psi is the function less the promised decrease: its minimum satisfies the first condition.
    const auto seen = [&](const Point& p) {
      return auxiliary ? Point{p.at, p.value - promised * p.at, p.slope - promised} : p;
    };
    Interval view = interval;
    view.best = seen(interval.best);
    view.other = seen(interval.other);
    const Point trial{at, now.value, now.slope};
    const double next = view.next(seen(trial), longest);
    const bool rose = seen(trial).value > seen(interval.best).value;
    const bool turned = seen(trial).slope * seen(interval.best).slope < 0.0;
    if (rose) {
      interval.other = trial;
    } else {
      if (turned) interval.other = interval.best;
      interval.best = trial;
    }
    interval.bracketed = view.bracketed;
    const double low = interval.bracketed ? std::min(interval.best.at, interval.other.at) : at;
    const double high = interval.bracketed ? std::max(interval.best.at, interval.other.at)
                                           : std::min(longest, at + 4.0 * (at - interval.other.at));
    at = std::min(std::max(next, low), std::min(high, longest));
    if (interval.bracketed && high - low < 1e-9 * longest) break;
  }
  result.length = lowest_at;
  if (lowest_at > 0.0 && lowest_at != last_at) function(lowest_at);
  return result;
}

}  // namespace relative_map::core
