#include "relative_map/prediction/predictors/drawing.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kRateTime = 0.7;      // [s] in which a lateral speed within the lane is steered away
constexpr double kResidualTime = 1.0;  // [s] in which what projection rounds off fades
constexpr std::size_t kChoice = 30;    // 3 s
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

Spread spread_of(const Situation& situation, const SpreadParam& param) {
  const MotionFilter::Covariance& covariance = situation.filter.covariance();
  const Point2 along = situation.forward(), across = left_of(along);
  const bool walks = situation.user->type() == RoadUserType::kPedestrian;
  const auto deviations = [&](const Point2& direction, double speed, double acceleration, auto& result) {
    const auto entry = [&](int row, int column) {
      return direction.dot(covariance.block<2, 2>(2 * row, 2 * column) * direction);
    };
    const double position = entry(0, 0), both = entry(0, 1), velocity = entry(1, 1) + speed * speed;
    for (std::size_t i = 0; i < kPredictionPoints; ++i) {
      const double t = kPredictionStep * static_cast<double>(i);
      const double gained = 0.5 * acceleration * t * t;
      result[i] = std::sqrt(position + 2.0 * t * both + t * t * velocity + gained * gained);
    }
  };
  Spread spread;
  deviations(along, walks ? param.pedestrian_speed : param.along_speed,
             walks ? param.pedestrian_acceleration : param.along_acceleration, spread.along);
  deviations(across, walks ? param.pedestrian_speed : param.across_speed,
             walks ? param.pedestrian_acceleration : param.across_acceleration, spread.across);
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
