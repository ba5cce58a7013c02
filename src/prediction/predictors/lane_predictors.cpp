#include "relative_map/prediction/predictors/lane_predictors.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/prediction/predictors/drawing.hpp"
#include "relative_map/prediction/predictors/free_move.hpp"
#include "relative_map/prediction/speed_model.hpp"

namespace relative_map::core {

namespace {

// Apollo's 0.995 and 0.95 of the offset a step of 0.1 s.
constexpr double kSlowly = 20.0, kFast = 2.0;  // [s]
constexpr double kLikely = 0.5;
constexpr double kForEver = 1e6;  // [s]

void normalize(std::vector<PredictedTrajectory>& trajectories) {
  double sum = 0.0;
  for (const auto& trajectory : trajectories) sum += trajectory.probability;
  for (auto& trajectory : trajectories) {
    trajectory.probability =
        sum > 0.0 ? trajectory.probability / sum : 1.0 / static_cast<double>(trajectories.size());
  }
  std::stable_sort(trajectories.begin(), trajectories.end(),
                   [](const auto& a, const auto& b) { return a.probability > b.probability; });
}

SpeedProfile steady(double speed, const SpeedParam& param) {
  return drive({speed, 0.0, 0.0, 0.0}, nullptr, nullptr, param);
}

/// Its velocity straight on.
PredictedTrajectory draw_straight(const Situation& situation, const Point2& velocity, const Spread& spread) {
  std::array<Point2, kPredictionPoints> positions;
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    positions[i] = situation.position() + kPredictionStep * static_cast<double>(i) * velocity;
  }
  PredictedTrajectory trajectory = draw_points(positions, situation.theta, spread);
  trajectory.probability = 1.0;
  return trajectory;
}

}  // namespace

std::vector<PredictedTrajectory> SingleLanePredictor::predict(const PredictionContext& context,
                                                              const Situation& situation) const {
  const Spread spread = spread_of(situation, context.config.spread);
  const SpeedProfile profile = steady(situation.speed, context.config.speed);
  std::vector<PredictedTrajectory> trajectories;
  for (const LaneOption& way : situation.options) {
    if (trajectories.size() >= static_cast<std::size_t>(context.config.lane.max_modes)) break;
    const double time = way.probability < kLikely ? kForEver : kSlowly;
    trajectories.push_back(draw_on_way(situation, way, profile, LateralMove::keep(way.l, 0.0, time), spread));
    trajectories.back().probability = way.probability;
  }
  normalize(trajectories);
  return trajectories;
}

std::vector<PredictedTrajectory> LaneSequencePredictor::predict(const PredictionContext& context,
                                                                const Situation& situation) const {
  const Spread spread = spread_of(situation, context.config.spread);
  const SpeedProfile profile = steady(situation.speed, context.config.speed);
  std::vector<PredictedTrajectory> trajectories;
  double side = 0.0;  // of the likeliest change; none to the other side
  for (const LaneOption& way : situation.options) {
    const bool likely = way.probability >= kLikely || trajectories.empty();
    if (!likely) continue;
    if (!way.inside()) {
      if (side * way.l < 0.0) continue;
      side = way.l;
    }
    const LateralMove lateral = LateralMove::keep(way.l, 0.0, way.inside() ? kSlowly : kFast);
    trajectories.push_back(draw_on_way(situation, way, profile, lateral, spread));
    trajectories.back().probability = way.probability;
  }
  normalize(trajectories);
  return trajectories;
}

std::vector<PredictedTrajectory> ExtrapolationPredictor::predict(const PredictionContext& context,
                                                                 const Situation& situation) const {
  constexpr double kMeanTime = 0.5;  // [s] of the last points, whose mean speed counts
  constexpr double kNearLane = 1.0;  // [m]
  const Spread spread = spread_of(situation, context.config.spread);
  const auto& history = situation.user->history();
  double speed = situation.speed;
  if (history.size() >= 2) {
    auto first = history.end() - 1;
    while (first != history.begin() && to_seconds(history.back().stamp - first->stamp) < kMeanTime) --first;
    const double span = to_seconds(history.back().stamp - first->stamp);
    if (span > 0.0) speed = (history.back().position - first->position).norm() / span;
  }
  speed = std::min(speed, context.config.store.max_speed);
  if (situation.still()) speed = 0.0;
  const LaneOption* best = situation.best();
  if (best != nullptr && std::abs(best->l) < kNearLane) {
    std::vector<PredictedTrajectory> one{draw_on_way(situation, *best, steady(speed, context.config.speed),
                                                     LateralMove::keep(best->l, 0.0, kSlowly), spread)};
    one.front().probability = 1.0;
    return one;
  }
  return {draw_straight(situation, speed * situation.forward(), spread)};
}

std::vector<PredictedTrajectory> RegionalPredictor::predict(const PredictionContext& context,
                                                            const Situation& situation) const {
  constexpr double kDeviations = 2.0;
  constexpr double kMaxSpeed = 10.0;  // [m/s] nobody runs faster
  const Spread spread = spread_of(situation, context.config.spread);
  Point2 velocity = situation.filter.velocity();
  if (situation.still()) velocity.setZero();
  if (velocity.norm() > kMaxSpeed) velocity *= kMaxSpeed / velocity.norm();
  std::vector<PredictedTrajectory> trajectories{draw_straight(situation, velocity, spread)};
  const Point2 across = left_of(situation.forward());
  for (const double side : {-kDeviations, kDeviations}) {
    std::array<Point2, kPredictionPoints> positions;
    for (std::size_t i = 0; i < kPredictionPoints; ++i) {
      positions[i] =
          trajectories.front().points[i].position + side * (spread.across[i] - spread.across[0]) * across;
    }
    trajectories.push_back(draw_points(positions, situation.theta, spread));
  }
  // Of a normal distribution, what is nearer to a border at two deviations than to the middle, lies beyond
  // one.
  trajectories[0].probability = 0.682;
  trajectories[1].probability = trajectories[2].probability = 0.159;
  return trajectories;
}

std::vector<PredictedTrajectory> InteractionPredictor::predict(const PredictionContext& context,
                                                               const Situation& situation) const {
  const LaneOption* best = situation.best();
  if (best == nullptr) return {};
  const Spread spread = spread_of(situation, context.config.spread);
  const bool yields = context.ego.right_of_way_is_sure || std::abs(best->turn) > 0.35;
  std::vector<PredictedTrajectory> trajectories;
  for (int half = 0; half <= 6; ++half) {
    const double braking = 0.5 * half;
    SpeedProfile profile;
    double s = 0.0, v = situation.speed;
    for (std::size_t i = 0; i < kPredictionPoints; ++i) {
      profile.s[i] = s;
      profile.v[i] = v;
      profile.a[i] = v > 0.0 ? -braking : 0.0;
      const double next = std::max(0.0, v - braking * kPredictionStep);
      s += 0.5 * (v + next) * kPredictionStep;
      v = next;
    }
    PredictedTrajectory trajectory = draw_on_way(
        situation, *best, profile, LateralMove::keep(best->l, best->lateral_speed, kSlowly), spread);
    double cost = 0.2 * braking * braking, centripetal = 0.0, nearness = 0.0;
    std::size_t hint = 0;
    for (std::size_t i = 0; i < kPredictionPoints; ++i) {
      const double kappa = best->path.at(best->path.place().s + profile.s[i], hint).kappa;
      centripetal = std::max(centripetal, std::abs(kappa) * profile.v[i] * profile.v[i]);
      // Compared with the plan as it is; it is looked at, and never changed.
      if (yields && i < context.ego.trajectory.size()) {
        const double d2 = (trajectory.points[i].position - context.ego.trajectory[i].position).squaredNorm();
        nearness = std::max(nearness, std::exp(-d2));
      }
    }
    cost += 0.1 * centripetal + nearness;
    trajectory.probability = std::exp(-cost);
    trajectories.push_back(std::move(trajectory));
    if (situation.speed <= 0.0) break;
  }
  normalize(trajectories);
  const auto most = static_cast<std::size_t>(context.config.lane.max_modes);
  if (trajectories.size() > most) trajectories.resize(most);
  normalize(trajectories);
  return trajectories;
}

}  // namespace relative_map::core
