#include "relative_map/prediction/selection_table.hpp"

#include <stdexcept>

#include "relative_map/prediction/evaluators/cost_evaluator.hpp"
#include "relative_map/prediction/predictors/free_move.hpp"
#include "relative_map/prediction/predictors/lane_predictors.hpp"
#include "relative_map/prediction/predictors/move_sequence.hpp"

namespace relative_map::core {

namespace {

constexpr RoadUserType kTypes[] = {RoadUserType::kUnknown,          RoadUserType::kUnknownMovable,
                                   RoadUserType::kUnknownUnmovable, RoadUserType::kPedestrian,
                                   RoadUserType::kBicycle,          RoadUserType::kVehicle};

}  // namespace

SelectionTable::SelectionTable(const std::string& preset) {
  evaluators_["cost"] = std::make_unique<CostEvaluator>();
  evaluators_["keep_lane"] = std::make_unique<KeepLaneEvaluator>();
  predictors_["single_lane"] = std::make_unique<SingleLanePredictor>();
  predictors_["lane_sequence"] = std::make_unique<LaneSequencePredictor>();
  predictors_["move_sequence"] = std::make_unique<MoveSequencePredictor>();
  predictors_["free_move"] = std::make_unique<FreeMovePredictor>();
  predictors_["extrapolation"] = std::make_unique<ExtrapolationPredictor>();
  predictors_["regional"] = std::make_unique<RegionalPredictor>();
  predictors_["interaction"] = std::make_unique<InteractionPredictor>();
  predictors_["empty"] = std::make_unique<EmptyPredictor>();
  if (preset != "default" && preset != "navi") {
    throw std::invalid_argument("there is no selection '" + preset + "', only default and navi");
  }
  // Off the lanes Apollo's navigation mode predicts nothing; here every road user gets a trajectory.
  const char* on_lane = preset == "navi" ? "single_lane" : "move_sequence";
  for (const RoadUserType type : kTypes) {
    services_[{type, Surrounding::kOffLane}] = {"cost", "free_move"};
    services_[{type, Surrounding::kOnLane}] = {"cost", on_lane};
  }
  services_[{RoadUserType::kPedestrian, Surrounding::kOnLane}] = {"cost", "free_move"};
  services_[{RoadUserType::kBicycle, Surrounding::kOnLane}] = {"keep_lane", on_lane};
}

const Service& SelectionTable::find(RoadUserType type, Surrounding surrounding) const {
  return services_.at({type, surrounding});
}

}  // namespace relative_map::core
