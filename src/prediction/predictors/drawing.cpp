#include "relative_map/prediction/predictors/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kRateTime = 0.7;      // [s] in which a lateral speed within the lane is steered away
constexpr double kResidualTime = 1.0;  // [s] in which what projection rounds off fades
constexpr std::size_t kChoice = 30;    // 3 s
// [m/s] of speeds, where positions are of the best: what recorded traffic shows.
constexpr double kVehicleAlongError = 1.0, kVehicleAcrossError = 0.4, kPedestrianError = 0.15;
// Slower than this, and than at first, it moves sideways only as it moves on [m/s].
constexpr double kCrawl = 3.0, kSlowestCrawl = 0.5;
constexpr double kShortestCurve = 0.2;  // [-] of the centerline's length
constexpr double kStandsBelow = 0.05;   // [m] between points: too little to tell a direction

}  // namespace

LateralMove LateralMove::keep(double l, double rate, double time) {
  LateralMove move;
  move.l_ = l;
  move.rate_ = rate;
  move.offset_factor_ = std::exp(-kPredictionStep / time);
  return move;
}

LateralMove LateralMove::change(double l, double rate, double time) {
  LateralMove move;
  move.l_ = l;
  move.rate_ = rate;
  move.time_ = time;
  move.keeps_ = false;
  return move;
}

double LateralMove::offset() const {
  if (keeps_) return offset_fade_ * (l_ + rate_ * kRateTime * (1.0 - rate_fade_));
  if (passed_ >= time_) return 0.0;
  // Hermite's cubic from (l, rate) to (0, 0).
  const double u = passed_ / time_;
  return l_ * (1.0 - u) * (1.0 - u) * (1.0 + 2.0 * u) + rate_ * time_ * u * (1.0 - u) * (1.0 - u);
}

void LateralMove::advance(double share) {
  static const double kRateFactor = std::exp(-kPredictionStep / kRateTime);
  passed_ += share * kPredictionStep;
  offset_fade_ *= 1.0 - share * (1.0 - offset_factor_);
  rate_fade_ *= 1.0 - share * (1.0 - kRateFactor);
}

Spread spread_of(const Situation& situation, const MotionFilterParam& param) {
  const AccelerationModel model = acceleration_model(situation.user->type(), param);
  const Point2 along = situation.forward(), across = left_of(along);
  const auto axis = [&](const Point2& direction) {
    Eigen::Matrix3d p;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        p(i, j) = direction.dot(situation.filter.covariance().block<2, 2>(2 * i, 2 * j) * direction);
      }
    }
    return p;
  };
  // A tracker's errors are alike from frame to frame: a speed is known less well than white noise says.
  const bool wheels = situation.user->on_wheels();
  const double along_rate = wheels ? kVehicleAlongError : kPedestrianError;
  const double across_rate = wheels ? kVehicleAcrossError : kPedestrianError;
  Eigen::Matrix3d p = axis(along), q = axis(across);
  p(1, 1) += along_rate * along_rate;
  q(1, 1) += across_rate * across_rate;
  const Eigen::Matrix3d f = singer_transition(kPredictionStep, model.time);
  const Eigen::Matrix3d noise = singer_noise(kPredictionStep, model.time);
  Spread spread;
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    spread.along[i] = std::sqrt(p(0, 0));
    spread.across[i] = std::sqrt(q(0, 0));
    p = f * p * f.transpose() + model.along * model.along * noise;
    q = f * q * f.transpose() + model.across * model.across * noise;
  }
  return spread;
}

namespace {

/// Direction and speed of points that were placed one by one; where it stands it looks where it looked.
void finish(PredictedTrajectory& trajectory, double theta) {
  auto& points = trajectory.points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, points.size() - 1);
    const Point2 step = points[after].position - points[before].position;
    if (step.norm() > kStandsBelow) theta = std::atan2(step.y(), step.x());
    points[i].theta = theta;
  }
}

}  // namespace

PredictedTrajectory draw_on_way(const Situation& situation, const LaneOption& option,
                                const SpeedProfile& profile, LateralMove lateral, const Spread& spread) {
  PredictedTrajectory trajectory;
  trajectory.lane_id = lane_after_choice(option, profile);
  trajectory.points.resize(kPredictionPoints);
  std::size_t hint = 0;
  Point2 residual = Point2::Zero();
  static const double kResidualFactor = std::exp(-kPredictionStep / kResidualTime);
  const double crawl = std::clamp(profile.v[0], kSlowestCrawl, kCrawl);
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    const LaneSample sample = option.path.at(option.path.place().s + profile.s[i], hint);
    TrajectoryPoint& point = trajectory.points[i];
    point.time = kPredictionStep * static_cast<double>(i);
    point.position = sample.position + lateral.offset() * left_of(sample.direction);
    if (i == 0) residual = situation.position() - point.position;
    point.position += residual;
    const double share = std::min(1.0, profile.v[i] / crawl);
    lateral.advance(share);
    residual *= 1.0 - share * (1.0 - kResidualFactor);
    // Inside a curve the way is shorter than the centerline's.
    point.speed = profile.v[i] * std::max(kShortestCurve, 1.0 - sample.kappa * lateral.offset());
    point.acceleration = profile.a[i];
    point.sigma_along = spread.along[i];
    point.sigma_across = spread.across[i];
  }
  finish(trajectory, situation.theta);
  return trajectory;
}

PredictedTrajectory draw_points(const std::array<Point2, kPredictionPoints>& positions, double theta,
                                const Spread& spread) {
  PredictedTrajectory trajectory;
  auto& points = trajectory.points;
  points.resize(kPredictionPoints);
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    points[i].time = kPredictionStep * static_cast<double>(i);
    points[i].position = positions[i];
    const std::size_t before = i == 0 ? 0 : i - 1, after = std::min(i + 1, kPredictionPoints - 1);
    points[i].speed = (positions[after] - positions[before]).norm() /
                      (kPredictionStep * static_cast<double>(after - before));
    points[i].sigma_along = spread.along[i];
    points[i].sigma_across = spread.across[i];
  }
  for (std::size_t i = 0; i + 1 < kPredictionPoints; ++i) {
    points[i].acceleration = (points[i + 1].speed - points[i].speed) / kPredictionStep;
  }
  points.back().acceleration = points[kPredictionPoints - 2].acceleration;
  finish(trajectory, theta);
  return trajectory;
}

std::string lane_after_choice(const LaneOption& option, const SpeedProfile& profile) {
  return option.path.view().lanes()[option.path.lane_at(option.path.place().s + profile.s[kChoice])].id;
}

}  // namespace relative_map::core
