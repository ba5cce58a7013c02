#pragma once

#include "relative_map/prediction/predictors/drawing.hpp"
#include "relative_map/prediction/predictors/predictor.hpp"

namespace relative_map::core {

/// Along the likeliest ways, in the moods that a driver may be in: as the speed model says, and slower and
/// faster than that. Laterally a cubic onto the way's centerline, or along the lane that it is on.
class MoveSequencePredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// The lateral part of it.
LateralMove lateral_move(const LaneOption& option);

}  // namespace relative_map::core
