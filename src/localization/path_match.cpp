#include "relative_map/localization/path_match.hpp"

#include <cmath>

namespace relative_map::core {

namespace {

constexpr std::size_t kLeast = 4;      // points: three would fit too often by chance
constexpr double kPathError = 0.05;    // [-] of the way: scale of the wheels, and turns that were not seen
constexpr double kMostResidual = 3.0;  // [-] in standard deviations

}  // namespace

void PathMatch::add(const Eigen::Vector2d& dead_reckoned, const Eigen::Vector2d& fix, double stddev) {
  // Standing adds nothing.
  if (!pairs_.empty() && (dead_reckoned - pairs_.back().path).norm() < 0.2) return;
  pairs_.push_back({dead_reckoned, fix, stddev});
  if (pairs_.size() <= kMost) return;
  std::vector<Pair> thinned;
  for (std::size_t i = 0; i < pairs_.size(); i += 2) thinned.push_back(pairs_[i]);
  pairs_ = std::move(thinned);
}

std::optional<PathMatch::Turn> PathMatch::turn() const {
  if (pairs_.size() < kLeast) return std::nullopt;
  const double count = static_cast<double>(pairs_.size());
  Eigen::Vector2d path_mean = Eigen::Vector2d::Zero(), fix_mean = Eigen::Vector2d::Zero();
  double variance = 0.0;
  for (const Pair& pair : pairs_) {
    path_mean += pair.path / count;
    fix_mean += pair.fix / count;
    variance += pair.stddev * pair.stddev / count;
  }
  double cosine = 0.0, sine = 0.0, spread = 0.0;
  for (const Pair& pair : pairs_) {
    const Eigen::Vector2d a = pair.path - path_mean, b = pair.fix - fix_mean;
    cosine += a.dot(b);
    sine += a.x() * b.y() - a.y() * b.x();
    spread += a.squaredNorm();
  }
  if (!(spread > 0.0)) return std::nullopt;
  Turn turn{std::atan2(sine, cosine), std::sqrt(variance / spread + kPathError * kPathError / count)};
  const double c = std::cos(turn.angle), s = std::sin(turn.angle);
  double residual = 0.0;
  for (const Pair& pair : pairs_) {
    const Eigen::Vector2d a = pair.path - path_mean;
    residual +=
        (pair.fix - fix_mean - Eigen::Vector2d(c * a.x() - s * a.y(), s * a.x() + c * a.y())).squaredNorm() /
        count;
  }
  const double allowed = 2.0 * variance + kPathError * kPathError * spread / count;
  if (residual > kMostResidual * kMostResidual * allowed) return std::nullopt;
  return turn;
}

}  // namespace relative_map::core
