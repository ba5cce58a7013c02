#include "relative_map/prediction/predictors/free_move.hpp"

#include <cmath>

#include "relative_map/prediction/predictors/drawing.hpp"

namespace relative_map::core {

namespace {

// 3.5 to 7.6 % of those that stand go on to move within 8 s (measured on recorded traffic): they have a way,
// too.
constexpr double kStartProbability = 0.07;
constexpr double kStart = 1.0;  // [m/s^2] of a vehicle that moves off
constexpr double kCrawl = 0.2;  // [m/s]
constexpr double kWalk = 1.3;   // [m/s] of a pedestrian who does

/// Straight on from a stand.
PredictedTrajectory draw_start(const Situation& situation, const Spread& spread) {
  std::array<Point2, kPredictionPoints> positions;
  const bool walks = situation.user->type() == RoadUserType::kPedestrian;
  double s = 0.0, v = 0.0;
  for (Point2& position : positions) {
    position = situation.position() + s * situation.forward();
    const double next = walks ? std::min(kWalk, v + kPredictionStep) : v + kStart * kPredictionStep;
    s += 0.5 * (v + next) * kPredictionStep;
    v = next;
  }
  return draw_points(positions, situation.theta, spread);
}

PredictedTrajectory draw_stand(const Situation& situation, const Spread& spread) {
  std::array<Point2, kPredictionPoints> positions;
  positions.fill(situation.position());
  return draw_points(positions, situation.theta, spread);
}

}  // namespace

PredictedTrajectory draw_free(const Situation& situation, const MotionFilterParam& param,
                              const Spread& spread) {
  const double time = acceleration_model(situation.user->type(), param).time;
  const Point2 velocity = situation.filter.velocity();
  const Point2 forward = situation.forward();
  std::array<Point2, kPredictionPoints> positions;
  Point2 acceleration = situation.filter.acceleration();
  // An acceleration against the way ends where it stands, and across it bends the way, but does not turn it
  // round.
  const double along = acceleration.dot(forward);
  Point2 across = acceleration - along * forward;
  const double most_across = 0.5 * velocity.norm() / time;
  if (across.norm() > most_across) across *= most_across / across.norm();
  acceleration = along * forward + across;
  Point2 position = situation.position(), v = velocity;
  const double fade = std::exp(-kPredictionStep / time);
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    positions[i] = position;
    Point2 next = v + kPredictionStep * acceleration;
    if (next.dot(velocity) <= 0.0) next.setZero();
    position += 0.5 * kPredictionStep * (v + next);
    v = next;
    if (v.isZero()) acceleration.setZero();
    acceleration *= fade;
  }
  // Where it goes is where it looks, unless it hardly goes.
  const double theta = velocity.norm() > kCrawl ? std::atan2(velocity.y(), velocity.x()) : situation.theta;
  return draw_points(positions, theta, spread);
}

std::vector<PredictedTrajectory> FreeMovePredictor::predict(const PredictionContext& context,
                                                            const Situation& situation) const {
  const MotionFilterParam& param = context.config.filter;
  const Spread spread = spread_of(situation, context.config.spread);
  std::vector<PredictedTrajectory> trajectories;
  if (situation.still()) {
    trajectories.push_back(draw_stand(situation, spread));
    trajectories.push_back(draw_start(situation, spread));
    trajectories[0].probability = 1.0 - kStartProbability;
    trajectories[1].probability = kStartProbability;
    return trajectories;
  }
  trajectories.push_back(draw_free(situation, param, spread));
  trajectories.back().probability = 1.0;
  return trajectories;
}

}  // namespace relative_map::core
