#pragma once

#include "relative_map/prediction/predictors/drawing.hpp"
#include "relative_map/prediction/predictors/predictor.hpp"

namespace relative_map::core {

/// Where no lane leads: the velocity that it has, with an acceleration that fades. Never through a U-turn.
class FreeMovePredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// Its straight course alone, without any lane.
PredictedTrajectory draw_free(const Situation& situation, const MotionFilterParam& param,
                              const Spread& spread);

}  // namespace relative_map::core
