#include "relative_map/prediction/selection_table.hpp"

#include <stdexcept>

#include "relative_map/prediction/evaluators/cost_evaluator.hpp"
#include "relative_map/prediction/evaluators/mlp_evaluator.hpp"
#include "relative_map/prediction/predictors/free_move.hpp"
#include "relative_map/prediction/predictors/lane_predictors.hpp"
#include "relative_map/prediction/predictors/move_sequence.hpp"

namespace relative_map::core {

namespace {

constexpr RoadUserType kTypes[] = {RoadUserType::kUnknown,          RoadUserType::kUnknownMovable,
                                   RoadUserType::kUnknownUnmovable, RoadUserType::kPedestrian,
                                   RoadUserType::kBicycle,          RoadUserType::kVehicle};

const ServicesParam& services_of(const PredictionConfig& config, RoadUserType type) {
  switch (type) {
    case RoadUserType::kVehicle:
      return config.vehicle;
    case RoadUserType::kBicycle:
      return config.bicycle;
    case RoadUserType::kPedestrian:
      return config.pedestrian;
    default:
      return config.unknown;
  }
}

ServiceParam service_of(const ServicesParam& services, Surrounding surrounding) {
  switch (surrounding) {
    case Surrounding::kOnLane:
      return services.on_lane;
    case Surrounding::kInteractive:
      return {services.on_lane.evaluator, services.interactive_predictor};
    default:
      return services.off_lane;
  }
}

}  // namespace

SelectionTable::SelectionTable(const PredictionConfig& config, std::shared_ptr<const Network> network) {
  const std::string& preset = config.selection;
  evaluators_["cost"] = std::make_unique<CostEvaluator>();
  if (network) evaluators_["mlp"] = std::make_unique<MlpEvaluator>(std::move(network));
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
  for (const RoadUserType type : kTypes) {
    for (const Surrounding surrounding :
         {Surrounding::kOnLane, Surrounding::kOffLane, Surrounding::kInteractive}) {
      Service& service = services_[{type, surrounding}];
      if (surrounding == Surrounding::kInteractive) service = services_[{type, Surrounding::kOnLane}];
      const ServiceParam other = service_of(services_of(config, type), surrounding);
      if (!other.evaluator.empty()) service.evaluator = other.evaluator;
      if (!other.predictor.empty()) service.predictor = other.predictor;
      if (evaluators_.count(service.evaluator) == 0 || predictors_.count(service.predictor) == 0) {
        throw std::invalid_argument("there is no evaluator '" + service.evaluator + "' or no predictor '" +
                                    service.predictor + "' here; mlp needs its network");
      }
    }
  }
}

const Service& SelectionTable::find(RoadUserType type, Surrounding surrounding) const {
  return services_.at({type, surrounding});
}

}  // namespace relative_map::core
