#pragma once

#include <memory>

#include "relative_map/prediction/road_user_store.hpp"
#include "relative_map/prediction/selection_table.hpp"

namespace relative_map::core {

/// Road users and lanes in, their futures out, all in the map frame. No clock: `now` is an argument.
class RoadUserPrediction {
 public:
  /// Throws std::invalid_argument for a configuration whose validate() finds faults, and where an evaluator
  /// mlp has no `network`.
  explicit RoadUserPrediction(const PredictionConfig& config,
                              std::shared_ptr<const Network> network = nullptr);

  /// What was seen, in the order of time.
  void see(const SeenRoadUsers& frame, const EgoVehicle& ego) { store_.add(frame, ego.pose.position()); }
  /// What those that are present at `now` may do in the next 8 s. `lanes` may be empty.
  Prediction predict(Time now, const EgoVehicle& ego, const LaneView& lanes) const;

  const RoadUserStore& store() const { return store_; }
  const PredictionConfig& config() const { return config_; }
  void reset() { store_.clear(); }

 private:
  PredictionConfig config_;
  RoadUserStore store_;
  SelectionTable selection_;
};

}  // namespace relative_map::core
