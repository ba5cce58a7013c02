#pragma once

#include <vector>

#include "relative_map/prediction/context.hpp"

namespace relative_map::core {

/// Draws what a road user may do, the likeliest first.
class Predictor {
 public:
  virtual ~Predictor() = default;
  /// Trajectories with probabilities that sum to one; none: it has nothing to say.
  virtual std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                                   const Situation& situation) const = 0;
};

}  // namespace relative_map::core
