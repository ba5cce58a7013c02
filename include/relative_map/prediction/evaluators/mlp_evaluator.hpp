#pragma once

#include <memory>

#include "relative_map/prediction/evaluators/evaluator.hpp"
#include "relative_map/prediction/network.hpp"

namespace relative_map::core {

/// What a network is told of a way, in this order.
const std::vector<std::string>& way_features();
Eigen::VectorXd features_of(const LaneOption& option, const Situation& situation);

/// Odds of each way from a network with one output, the logarithm of the odds. Ways that it can't judge (an
/// output that is not finite) share the odds of the unlikeliest.
class MlpEvaluator : public Evaluator {
 public:
  /// Throws std::runtime_error for a network that has not one output.
  explicit MlpEvaluator(std::shared_ptr<const Network> network);
  void evaluate(const PredictionContext& context, Situation& situation) const override;

 private:
  std::shared_ptr<const Network> network_;
};

}  // namespace relative_map::core
