#include "relative_map/route/box_smoother.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr std::size_t kBand = 3;  // a third difference ties a point to the three before it
constexpr int kMostRounds = 60;
constexpr double kPinned = 1e-4;   // [m] bounds that are nearer leave no room
constexpr double kInside = 0.99;   // of the way to the nearest bound, at most
constexpr double kSolved = 1e-10;  // [-] of the mean complementarity

/// A symmetric matrix of half bandwidth 3: row i holds entries (i, i), (i, i - 1) ... (i, i - 3).
using Banded = std::vector<std::array<double, kBand + 1>>;

/// Factors it in place as L D L'; false if it is not positive definite.
bool factor(Banded& a) {
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t back = std::min(i, kBand); back > 0; --back) {
      const std::size_t j = i - back;
      double sum = a[i][back];
      for (std::size_t k = back + 1; k <= std::min(i, kBand); ++k) {
        sum -= a[i][k] * a[i - k][0] * a[j][k - back];
      }
      a[i][back] = sum / a[j][0];
    }
    for (std::size_t back = 1; back <= std::min(i, kBand); ++back) {
      a[i][0] -= a[i][back] * a[i][back] * a[i - back][0];
    }
    if (!(a[i][0] > 0.0)) return false;
  }
  return true;
}

void solve(const Banded& l, std::vector<double>& x) {
  const std::size_t n = x.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t k = 1; k <= std::min(i, kBand); ++k) x[i] -= l[i][k] * x[i - k];
  }
  for (std::size_t i = 0; i < n; ++i) x[i] /= l[i][0];
  for (std::size_t i = n; i > 0; --i) {
    for (std::size_t k = 1; k <= kBand && i - 1 + k < n; ++k) x[i - 1] -= l[i - 1 + k][k] * x[i - 1 + k];
  }
}

/// 1/2 x'Hx - g'x of the sum of squares.
struct Program {
  Banded hessian;
  std::vector<double> gradient;
};

Program program_of(const std::vector<Anchor>& anchors, double follow) {
  constexpr std::array<double, kBand + 1> kThird = {-1.0, 3.0, -3.0, 1.0};
  const std::size_t n = anchors.size();
  Program program{Banded(n, {0.0, 0.0, 0.0, 0.0}), std::vector<double>(n, 0.0)};
  for (std::size_t i = 0; i < n; ++i) {
    program.hessian[i][0] += follow;
    program.gradient[i] += follow * anchors[i].wanted;
  }
  for (std::size_t first = 0; first + kBand < n; ++first) {
    Point2 fixed = Point2::Zero();
    for (std::size_t k = 0; k <= kBand; ++k) fixed += kThird[k] * anchors[first + k].point;
    for (std::size_t k = 0; k <= kBand; ++k) {
      const std::size_t i = first + k;
      program.gradient[i] -= kThird[k] * anchors[i].left.dot(fixed);
      for (std::size_t m = 0; m <= k; ++m) {
        program.hessian[i][k - m] += kThird[k] * kThird[m] * anchors[i].left.dot(anchors[first + m].left);
      }
    }
  }
  return program;
}

std::vector<double> times(const Banded& a, const std::vector<double>& x) {
  std::vector<double> y(x.size(), 0.0);
  for (std::size_t i = 0; i < x.size(); ++i) {
    y[i] += a[i][0] * x[i];
    for (std::size_t k = 1; k <= std::min(i, kBand); ++k) {
      y[i] += a[i][k] * x[i - k];
      y[i - k] += a[i][k] * x[i];
    }
  }
  return y;
}

}  // namespace

std::vector<double> smooth_within(const std::vector<Anchor>& anchors, double follow) {
  const std::size_t n = anchors.size();
  const Program program = program_of(anchors, follow);
  std::vector<double> x(n), low(n), high(n), at_low(n), at_high(n), right(n);
  double scale = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    // No room at all would leave no inside: a hair of it.
    const double middle = (anchors[i].lower + anchors[i].upper) / 2.0;
    const double room = std::max((anchors[i].upper - anchors[i].lower) / 2.0, kPinned / 2.0);
    low[i] = middle - room;
    high[i] = middle + room;
    x[i] = middle;
    scale = std::max(scale, std::abs(program.gradient[i]));
  }
  const double start = std::max(scale * 0.1, 1e-6);
  std::fill(at_low.begin(), at_low.end(), start);
  std::fill(at_high.begin(), at_high.end(), start);
  for (int round = 0; round < kMostRounds; ++round) {
    double gap = 0.0;
    for (std::size_t i = 0; i < n; ++i) gap += (x[i] - low[i]) * at_low[i] + (high[i] - x[i]) * at_high[i];
    gap /= 2.0 * static_cast<double>(n);
    if (gap < kSolved * std::max(start, 1e-3)) break;
    const double target = 0.1 * gap;
    Banded matrix = program.hessian;
    const std::vector<double> hx = times(program.hessian, x);
    for (std::size_t i = 0; i < n; ++i) {
      const double to_low = x[i] - low[i], to_high = high[i] - x[i];
      matrix[i][0] += at_low[i] / to_low + at_high[i] / to_high;
      right[i] = program.gradient[i] - hx[i] + target / to_low - target / to_high;
    }
    if (!factor(matrix)) return {};
    solve(matrix, right);
    double step = 1.0;  // one for both: the program is not linear
    std::vector<double> low_change(n), high_change(n);
    for (std::size_t i = 0; i < n; ++i) {
      const double to_low = x[i] - low[i], to_high = high[i] - x[i];
      low_change[i] = (target - at_low[i] * right[i]) / to_low - at_low[i];
      high_change[i] = (target + at_high[i] * right[i]) / to_high - at_high[i];
      if (right[i] < 0.0) step = std::min(step, -kInside * to_low / right[i]);
      if (right[i] > 0.0) step = std::min(step, kInside * to_high / right[i]);
      if (low_change[i] < 0.0) step = std::min(step, -kInside * at_low[i] / low_change[i]);
      if (high_change[i] < 0.0) step = std::min(step, -kInside * at_high[i] / high_change[i]);
    }
    for (std::size_t i = 0; i < n; ++i) {
      x[i] += step * right[i];
      at_low[i] += step * low_change[i];
      at_high[i] += step * high_change[i];
      if (!std::isfinite(x[i])) return {};
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    if (anchors[i].upper - anchors[i].lower < kPinned) x[i] = (anchors[i].lower + anchors[i].upper) / 2.0;
  }
  return x;
}

}  // namespace relative_map::core
