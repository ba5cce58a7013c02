#include "steering.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kReach = 1.0;      // [m] that curvature is averaged over: noise has less of a say
constexpr double kMaxSpeed = 15.0;  // [m/s]
constexpr double kSideways = 3.0;   // [m/s^2] of acceleration that a curve is driven with

/// The integral of the curvature from the start of a path, linear between its points.
class CurvatureIntegral {
 public:
  CurvatureIntegral(const PathPoints& path, Ends ends, double length) : closed_(ends == Ends::kClosed) {
    for (const PathPoint& point : path) add(point.s, point.kappa);
    if (closed_) add(length, path.front().kappa);
  }
  double length() const { return s_.back(); }
  /// Beyond the seam of a lap it goes on.
  double up_to(double s) const {
    double turns = 0.0;
    if (closed_ && s < 0.0) {
      s += length();
      turns = -sums_.back();
    } else if (closed_ && s >= length()) {
      s -= length();
      turns = sums_.back();
    }
    const auto after = std::upper_bound(s_.begin(), s_.end(), s);
    const auto i = static_cast<std::size_t>(
        std::clamp<std::ptrdiff_t>(after - s_.begin() - 1, 0, static_cast<std::ptrdiff_t>(s_.size()) - 2));
    const double step = s - s_[i], slope = (kappa_[i + 1] - kappa_[i]) / (s_[i + 1] - s_[i]);
    return turns + sums_[i] + step * (kappa_[i] + 0.5 * step * slope);
  }

 private:
  void add(double s, double kappa) {
    sums_.push_back(s_.empty() ? 0.0 : sums_.back() + 0.5 * (kappa_.back() + kappa) * (s - s_.back()));
    s_.push_back(s);
    kappa_.push_back(kappa);
  }

  bool closed_;
  std::vector<double> s_, kappa_, sums_;
};

}  // namespace

std::vector<Steering> steering_along(const PathPoints& path, Ends ends, double length) {
  std::vector<Steering> result(path.size());
  const CurvatureIntegral integral(path, ends, length);
  if (integral.length() < 2.0 * kReach) return result;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double s = path[i].s;
    if (ends == Ends::kOpen && (s < kReach || s > integral.length() - kReach)) continue;
    Steering& steering = result[i];
    const double here = integral.up_to(s);
    steering.before = (here - integral.up_to(s - kReach)) / kReach;
    steering.after = (integral.up_to(s + kReach) - here) / kReach;
    const double kappa = std::max(std::abs(steering.before), std::abs(steering.after));
    steering.speed = kappa > 0.0 ? std::min(kMaxSpeed, std::sqrt(kSideways / kappa)) : kMaxSpeed;
    steering.rate = steering.speed * std::abs(steering.after - steering.before) / kReach;
  }
  return result;
}

}  // namespace relative_map::core
