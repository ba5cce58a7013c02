#include "relative_map/pipeline/estimation/lane_estimator.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/estimation/half_width_model.hpp"

namespace relative_map::core {

namespace {

// Standard deviations at the start.
constexpr double kBias0 = 0.6;          // [m]
constexpr double kHeadingBias0 = 0.01;  // [rad]
constexpr double kTurnBias0 = 0.003;    // [rad/s]
constexpr double kCameraYaw0 = 0.005;   // [rad]
// Of localization, white from message to message.
constexpr double kPositionNoise = 0.03;   // [m] at least
constexpr double kHeadingNoise = 0.0035;  // [rad] at least
// Random walks, by the root of the time [s].
constexpr double kBiasWalk = 0.15;           // [m]
constexpr double kHeadingBiasWalk = 0.0015;  // [rad]
constexpr double kHeadingWalk = 0.002;       // [rad] of odometry
constexpr double kSlipWalk = 0.02;           // [m] of odometry, sideways
constexpr double kSpeedWalk = 0.05;          // [m] of odometry, along
constexpr double kTurnBiasWalk = 5e-5;       // [rad/s]
constexpr double kCameraYawWalk = 1e-4;      // [rad]
constexpr double kSpeedScale = 0.01;         // [-] of the speed, besides

constexpr double kJumpDistance = 40.0;   // squared, in standard deviations: localization has jumped
constexpr double kRecording = 0.4;       // [m] of one line against another
constexpr double kOtherWidth = 0.1;      // [m] of one lane against another
constexpr double kMaxHeadingBias = 0.1;  // [rad] of localization: no estimate beyond it is one
constexpr double kLongestGap = 1.0;      // [s] between poses that odometry bridges
constexpr double kListenTime = 1.0;      // [s] over which localization's noise is measured
constexpr double kLoudest = 1.0;         // [m] of it: more is a jump
constexpr double kHoldTime = 1.0;        // [s] without paint until the estimate starts to decay
constexpr double kForgetTime = 60.0;     // [s] without paint until nothing is left worth having
constexpr double kBehind = 1.5;          // knots behind the vehicle

using Vector3 = Eigen::Vector3d;

}  // namespace

void LaneEstimator::start(const VehicleState& localized) {
  *this = [&] {
    LaneEstimator fresh;
    fresh.half_width_ = half_width_;
    fresh.given_up_ = given_up_;
    fresh.watch_ = watch_;
    fresh.position_variance_ = position_variance_;
    fresh.heading_variance_ = heading_variance_;
    return fresh;
  }();
  origin_ = localized.map_from_base.position();
  Filter::State& x = filter_.state();
  Filter::Covariance& p = filter_.covariance();
  x[kHeading] = localized.map_from_base.heading();
  const Vector3 bias(kBias0 * kBias0, kBias0 * kBias0, kHeadingBias0 * kHeadingBias0);
  const Vector3 noise(kPositionNoise * kPositionNoise, kPositionNoise * kPositionNoise,
                      kHeadingNoise * kHeadingNoise);
  p.block<3, 3>(kBiasX, kBiasX) = bias.asDiagonal();
  p.block<3, 3>(kX, kX) = (bias + noise).asDiagonal();
  p.block<3, 3>(kX, kBiasX) = p.block<3, 3>(kBiasX, kX) = -p.block<3, 3>(kBiasX, kBiasX);
  x[kLeft] = x[kRight] = half_width_;
  p.block<2, 2>(kLeft, kLeft) = HalfWidthModel::unknown();
  p(kTurnBias, kTurnBias) = kTurnBias0 * kTurnBias0;
  p(kCameraYaw, kCameraYaw) = kCameraYaw0 * kCameraYaw0;
  p.block<OffsetProfile::kKnots, OffsetProfile::kKnots>(kFirstKnot, kFirstKnot) = OffsetProfile::prior();
  last_ = localized;
}

void LaneEstimator::give_up(const VehicleState& localized, const std::string& why) {
  start(localized);
  given_up_ = why;
}

void LaneEstimator::move(const VehicleState& localized, const LaneFusionParam& param) {
  watch_.max_offset = param.max_offset;
  const bool forgotten = last_paint_ && to_seconds(localized.stamp - *last_paint_) > kForgetTime;
  const bool gap = last_ && to_seconds(localized.stamp - last_->stamp) > kLongestGap;
  const bool broken = !filter_.sound();
  if (last_ && informed() &&
      (forgotten || gap || broken || has_jumped(*last_, localized) || localized.stamp <= last_->stamp)) {
    start(localized);
  }
  if (last_) listen(localized);
  if (!last_ || !informed()) {  // nothing to tell bias from place by
    last_ = localized;
    return;
  }
  const double dt = to_seconds(localized.stamp - last_->stamp);
  if (to_seconds(localized.stamp - *last_paint_) > kHoldTime) decay(std::exp(-dt / param.decay_time));
  follow_odometry(localized, dt);
  follow_localization(localized);
  last_ = localized;
  const Filter::State& x = filter_.state();
  const double offset = x.segment<2>(kBiasX).norm();
  if (offset > param.max_offset || std::abs(x[kBiasHeading]) > kMaxHeadingBias) {
    std::ostringstream why;
    why.precision(3);
    why << "the lane seemed to be " << offset << " m and " << std::abs(x[kBiasHeading])
        << " rad from where localization puts it: not believed";
    give_up(localized, why.str());
  }
}

/// How noisy localization is: what one pose is off by from where odometry goes from the one before.
void LaneEstimator::listen(const VehicleState& localized) {
  const double dt = to_seconds(localized.stamp - last_->stamp);
  const Pose2 expected = carried_on(*last_, dt);
  const double aside = (localized.map_from_base.position() - expected.position()).norm();
  const double turned = angle_difference(localized.map_from_base.heading(), expected.heading());
  if (!(dt > 0.0) || !(aside < kLoudest) || !(std::abs(turned) < kMaxHeadingBias)) return;
  const double share = std::min(1.0, dt / kListenTime);
  position_variance_ +=
      share * (0.25 * aside * aside - position_variance_);  // of two poses, in two directions
  heading_variance_ += share * (0.5 * turned * turned - heading_variance_);
}

/// Back to what localization says, and to the lane that is expected.
void LaneEstimator::decay(double kept) {
  Eigen::Matrix<double, 6, 6> f = f.Identity();
  f.topRightCorner<3, 3>() = (1.0 - kept) * Eigen::Matrix3d::Identity();
  f.bottomRightCorner<3, 3>() *= kept;
  filter_.predict_part<kX, 6>(f * filter_.state().segment<6>(kX), f, f.Zero());
  auto half_widths = filter_.state().segment<2>(kLeft).array();
  half_widths += (1.0 - kept) * (half_width_ - half_widths);
}

void LaneEstimator::follow_odometry(const VehicleState& to, double dt) {
  const double way = 0.5 * (last_->speed + to.speed) * dt;
  Eigen::Vector4d moved = filter_.state().segment<4>(kTurnBias);  // with the pose
  const double turn = (0.5 * (last_->yaw_rate + to.yaw_rate) - moved[0]) * dt;
  const double heading = moved[3] + 0.5 * turn;
  const Point2 ahead(std::cos(heading), std::sin(heading)), left = left_of(ahead);
  moved += Eigen::Vector4d(0.0, way * ahead.x(), way * ahead.y(), turn);
  Eigen::Matrix4d f = f.Identity(), q = q.Zero();
  f.block<2, 1>(1, 3) = way * left;
  f(3, 0) = -dt;
  const double along = kSpeedWalk * kSpeedWalk * dt + kSpeedScale * kSpeedScale * std::abs(to.speed * way);
  const double aside = kSlipWalk * kSlipWalk * dt;
  q(0, 0) = kTurnBiasWalk * kTurnBiasWalk * dt;
  q.block<2, 2>(1, 1) = along * ahead * ahead.transpose() + aside * left * left.transpose();
  q(3, 3) = kHeadingWalk * kHeadingWalk * dt;
  filter_.predict_part<kTurnBias, 4>(moved, f, q);

  const Vector3 bias_walk(kBiasWalk, kBiasWalk, kHeadingBiasWalk);
  filter_.covariance().diagonal().segment<3>(kBiasX) += dt * bias_walk.cwiseAbs2();

  filter_.covariance()(kCameraYaw, kCameraYaw) += kCameraYawWalk * kCameraYawWalk * dt;
  const Eigen::Matrix2d kept = HalfWidthModel::transition(std::abs(way));
  filter_.predict_part<kLeft, 2>(kept * filter_.state().segment<2>(kLeft), kept,
                                 HalfWidthModel::noise(std::abs(way)));
}

void LaneEstimator::follow_localization(const VehicleState& localized) {
  Filter::State& x = filter_.state();
  Filter::Covariance& p = filter_.covariance();
  const Point2 position = localized.map_from_base.position() - origin_;
  const auto innovation = [&]() -> Vector3 {
    return {position.x() - x[kX] - x[kBiasX], position.y() - x[kY] - x[kBiasY],
            angle_difference(localized.map_from_base.heading(), x[kHeading] + x[kBiasHeading])};
  };
  const double position_noise = std::max(kPositionNoise, std::sqrt(position_variance_));
  const Vector3 noise(position_noise, position_noise, std::max(kHeadingNoise, std::sqrt(heading_variance_)));
  const auto expect = [&] {  // pose plus bias
    Filter::Expected<3> expected;
    expected.cross = p.middleCols<3>(kX) + p.middleCols<3>(kBiasX);
    expected.covariance = expected.cross.middleRows<3>(kX) + expected.cross.middleRows<3>(kBiasX);
    expected.covariance.diagonal() += noise.cwiseAbs2();
    return expected;
  };
  Filter::Expected<3> expected = expect();
  const Vector3 gap = innovation();
  if (expected.squared_distance(gap) > kJumpDistance) {
    // Vehicles do not jump, localization does: its bias is another one now. Headings are another matter:
    // localization's hardly drift, and odometry's do where a yaw rate is wrong.
    x.segment<2>(kBiasX) += gap.head<2>();
    x[kHeading] += gap[2];
    for (int i = 0; i < 2; ++i) p(kBiasX + i, kBiasX + i) += 0.05 * gap[i] * gap[i];
    p(kHeading, kHeading) += gap[2] * gap[2];
    expected = expect();
  }
  filter_.correct(innovation(), expected);
}

/// [m] the same as line_s_ for a place that is s along the line; the nearest one, on a lap.
double LaneEstimator::s_along(const NavigationLine& line, double s) const {
  const double step = s - last_projected_s_;
  return line_s_ + (line.closed() ? std::remainder(step, line.length) : step);
}

void LaneEstimator::follow_line(const NavigationLine& line, const LineProjection& projection) {
  if (!last_) return;
  if (!informed()) start(*last_);
  const double moved = s_along(line, projection.s) - line_s_;
  last_projected_s_ = projection.s;
  constexpr int kKnots = OffsetProfile::kKnots;
  constexpr double kSpacing = OffsetProfile::kSpacing;
  Filter::State& x = filter_.state();
  Filter::Covariance& p = filter_.covariance();
  if (line.id != line_id_ || !(std::abs(moved) <= kKnots * kSpacing)) {  // NaN is no way either
    line_id_ = line.id;
    next_left_ = next_right_ = NextBorder();
    line_s_ = projection.s;
    first_knot_s_ = line_s_ - kBehind * kSpacing;
    x.tail<kKnots>().setZero();
    p.rightCols<kKnots>().setZero();
    p.bottomRows<kKnots>().setZero();
    p.bottomRightCorner<kKnots, kKnots>() = OffsetProfile::prior();
    // Each line has been recorded with an error of its own, and each lane has its width.
    doubt_bias(kRecording * kRecording);
    p.block<2, 2>(kLeft, kLeft) += HalfWidthModel::covariance(kOtherWidth * kOtherWidth, 0.0);
    return;
  }
  line_s_ += moved;
  const OffsetProfile::Next next = OffsetProfile::next();
  while (std::abs(line_s_ - first_knot_s_ - kBehind * kSpacing) > 0.5 * kSpacing) {
    const bool ahead = line_s_ - first_knot_s_ > kBehind * kSpacing;
    Filter::Covariance f = f.Identity(), q = q.Zero();
    f.bottomRightCorner<kKnots, kKnots>().setZero();
    const int first = kFirstKnot, last = kFirstKnot + kKnots - 1;
    for (int i = 1; i < kKnots; ++i) {
      ahead ? f(first + i - 1, first + i) = 1.0 : f(first + i, first + i - 1) = 1.0;
    }
    const int fresh = ahead ? last : first, inward = ahead ? -1 : 1;
    f(fresh, fresh) = next.from_near;  // by the knots as they were numbered before
    f(fresh, fresh + inward) = next.from_far;
    q(fresh, fresh) = next.variance;
    filter_.predict(f, q);
    first_knot_s_ += ahead ? kSpacing : -kSpacing;
  }
}

/// Localization's bias may have changed by so much [m^2], and the vehicle's place with it.
void LaneEstimator::doubt_bias(double variance) {
  Filter::Covariance& p = filter_.covariance();
  for (int i = 0; i < 2; ++i) {
    p(kX + i, kX + i) += variance;
    p(kBiasX + i, kBiasX + i) += variance;
    p(kX + i, kBiasX + i) -= variance;
    p(kBiasX + i, kX + i) -= variance;
  }
}

}  // namespace relative_map::core
