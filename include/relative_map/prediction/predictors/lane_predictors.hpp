#pragma once

#include "relative_map/prediction/predictors/predictor.hpp"

namespace relative_map::core {

/// As Apollo's navigation mode: every way at constant speed; the lateral offset fades within 20 s on likely
/// ways, and stays on others.
class SingleLanePredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// Likely ways at constant speed; the offset fades within 20 s on lanes that it is on, within 2 s on others.
/// With changes to one side only, the likelier one.
class LaneSequencePredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// Straight on at the mean speed of the last moment, or along a lane that it is near, at that speed.
class ExtrapolationPredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// A pedestrian's region: the way that it goes, and to both sides of it the borders at two standard
/// deviations.
class RegionalPredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// How hard a vehicle brakes for the one that predicts: accelerations 0 .. -3 m/s^2 on its likeliest way,
/// each as likely as its cost is low (effort, centripetal acceleration, nearness to the vehicle's own
/// trajectory).
class InteractionPredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext& context,
                                           const Situation& situation) const override;
};

/// Has nothing to say.
class EmptyPredictor : public Predictor {
 public:
  std::vector<PredictedTrajectory> predict(const PredictionContext&, const Situation&) const override {
    return {};
  }
};

}  // namespace relative_map::core
