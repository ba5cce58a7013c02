#pragma once

#include "relative_map/prediction/evaluators/evaluator.hpp"

namespace relative_map::core {

/// What speaks against a way, each term the logarithm of the odds that it costs.
struct LaneCost {
  double offset = 0.0;   ///< how far from its centerline the road user will be in a moment
  double change = 0.0;   ///< it would have to change lanes
  double turn = 0.0;     ///< most go straight on
  double braking = 0.0;  ///< it is too fast for the curves ahead

  double sum() const { return offset + change + turn + braking; }
};

LaneCost lane_cost(const LaneOption& option, double speed, double acceleration, const LaneChoiceParam& param);

/// Odds of each way from its own lateral offset, not from that of the lane which the road user is on.
class CostEvaluator : public Evaluator {
 public:
  void evaluate(const PredictionContext& context, Situation& situation) const override;
};

/// All on the own lane, as far as there is one; for bicycles.
class KeepLaneEvaluator : public Evaluator {
 public:
  void evaluate(const PredictionContext& context, Situation& situation) const override;
};

}  // namespace relative_map::core
