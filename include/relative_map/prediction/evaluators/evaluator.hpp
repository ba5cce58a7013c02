#pragma once

#include <string>

#include "relative_map/prediction/context.hpp"

namespace relative_map::core {

/// Says how likely a road user takes each of its ways.
class Evaluator {
 public:
  virtual ~Evaluator() = default;
  /// Sets the probability of each of `situation.options`; they sum to one, if there are any.
  virtual void evaluate(const PredictionContext& context, Situation& situation) const = 0;
};

/// Makes probabilities of `odds`, one for each option and none below 0, and sorts options by them.
void set_probabilities(const std::vector<double>& odds, std::vector<LaneOption>& options);

}  // namespace relative_map::core
