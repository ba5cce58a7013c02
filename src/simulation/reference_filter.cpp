#include "relative_map/simulation/reference_filter.hpp"

#include <Eigen/Cholesky>
#include <cmath>

namespace relative_map::core {

namespace {

// Round numbers that anyone would begin with; they are not tuned, and no world knows them.
constexpr double kOffset = 1.0, kHeading = 0.02, kWidth = 0.25;              // [m, rad, m] at first
constexpr double kHalfWidth = 1.75;                                          // [m] at first
constexpr double kOffsetWalk = 0.1, kHeadingWalk = 0.01, kWidthWalk = 0.05;  // by the root of a second
constexpr double kPaint = 0.1, kPaintByX = 0.01;                             // [m], [-] of a sample at x
constexpr double kSides = 0.1;                                               // [m] between the half widths
constexpr double kLost = 2.0;  // [m] once nothing has fitted for a while
constexpr double kGate = 3.0;  // standard deviations

}  // namespace

void ReferenceFilter::restart() {
  state_ = {0.0, 0.0, kHalfWidth, kHalfWidth};
  covariance_ =
      Eigen::Vector4d(kOffset * kOffset, kHeading * kHeading, kWidth * kWidth, kWidth * kWidth).asDiagonal();
}

void ReferenceFilter::forget_widths() {
  for (const int i : {2, 3}) {
    state_[i] = kHalfWidth;
    covariance_.row(i).setZero();
    covariance_.col(i).setZero();
    covariance_(i, i) = kWidth * kWidth;
  }
}

void ReferenceFilter::doubt() {
  covariance_ =
      Eigen::Vector4d(kLost * kLost, kHeading * kHeading, kWidth * kWidth, kWidth * kWidth).asDiagonal();
}

void ReferenceFilter::predict(double dt) {
  const Eigen::Vector4d walk(kOffsetWalk, kHeadingWalk, kWidthWalk, kWidthWalk);
  covariance_.diagonal() += dt * walk.cwiseAbs2();
  // Paint alone does not tell a lane that has moved from one whose sides have: the center is in the middle.
  correct({0.0, 0.0, 1.0, -1.0}, 0.0, kSides * kSides);
}

void ReferenceFilter::correct(const Eigen::RowVector4d& h, double measured, double variance) {
  const Eigen::Vector4d projected = covariance_ * h.transpose();
  const Eigen::Vector4d gain = projected / (h.dot(projected.transpose()) + variance);
  state_ += gain * (measured - h.dot(state_.transpose()));
  covariance_ -= gain * projected.transpose();
}

void ReferenceFilter::shift(double offset, double heading) {
  state_[0] += offset;
  state_[1] += heading;
}

bool ReferenceFilter::update(bool left, const std::vector<Sample>& samples) {
  const auto row_of = [&](const Sample& sample) {
    const double side = left ? sample.stretch : -sample.stretch;
    return Eigen::RowVector4d(1.0, sample.x, left ? side : 0.0, left ? 0.0 : side);
  };
  // The samples of a marker err together: as many as there are, they tell as much as two.
  const double shared = std::max(1.0, 0.5 * static_cast<double>(samples.size()));
  const auto variance_of = [&](const Sample& sample) {
    const double deviation = kPaint + kPaintByX * sample.x;
    return shared * deviation * deviation;
  };
  const Eigen::RowVector4d nearest = row_of(samples.front());
  const double surprise = samples.front().y - nearest.dot(state_.transpose());
  const double expected =
      (nearest * covariance_ * nearest.transpose()).value() + variance_of(samples.front());
  if (surprise * surprise > kGate * kGate * expected) return false;
  for (const Sample& sample : samples) correct(row_of(sample), sample.y, variance_of(sample));
  return true;
}

}  // namespace relative_map::core
