#include "relative_map/prediction/evaluators/cost_evaluator.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kTurn = 0.35;  // [rad] 20 degrees: who bends away by more has turned off

}  // namespace

LaneCost lane_cost(const LaneOption& option, double speed, double acceleration,
                   const LaneChoiceParam& param) {
  LaneCost cost;
  // The lateral speed carries on for the preview, but no farther than over to the other side of the way.
  double drift = option.lateral_speed * param.preview_time;
  if (option.l * drift < 0.0)
    drift = std::copysign(std::min(std::abs(drift), std::abs(option.l) + 0.5), drift);
  cost.offset = std::abs(option.l + drift) / param.offset_scale;
  if (!option.inside()) cost.change = -std::log(param.change_odds);
  cost.turn = -std::log(param.turn_odds) * std::min(1.0, option.bend / kTurn);
  // Who brakes already may be braking for the curve; who needs to brake harder than most do is not going
  // there.
  const double excess = option.braking - std::max(1.0, 1.0 - acceleration);
  if (excess > 0.0 && speed > 1.0) cost.braking = 0.5 * std::pow(excess / param.brake_scale, 2.0);
  return cost;
}

void CostEvaluator::evaluate(const PredictionContext& context, Situation& situation) const {
  std::vector<double> odds;
  for (const LaneOption& option : situation.options) {
    odds.push_back(
        std::exp(-lane_cost(option, situation.speed, situation.acceleration, context.config.lane).sum()));
  }
  set_probabilities(odds, situation.options);
}

void KeepLaneEvaluator::evaluate(const PredictionContext& context, Situation& situation) const {
  const bool any_inside = std::any_of(situation.options.begin(), situation.options.end(),
                                      [](const LaneOption& option) { return option.inside(); });
  std::vector<double> odds;
  for (const LaneOption& option : situation.options) {
    const LaneCost cost = lane_cost(option, situation.speed, situation.acceleration, context.config.lane);
    odds.push_back(any_inside && !option.inside() ? 0.0 : std::exp(-cost.sum()));
  }
  set_probabilities(odds, situation.options);
}

}  // namespace relative_map::core
