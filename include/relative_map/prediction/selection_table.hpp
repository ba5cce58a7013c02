#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "relative_map/prediction/evaluators/evaluator.hpp"
#include "relative_map/prediction/network.hpp"
#include "relative_map/prediction/predictors/predictor.hpp"

namespace relative_map::core {

/// Where a road user is.
enum class Surrounding { kOnLane, kOffLane, kInteractive };

/// Who is served by what.
struct Service {
  std::string evaluator, predictor;
};

/// Which evaluator and which predictor serve a road user.
class SelectionTable {
 public:
  /// The preset that the configuration names, "default" or "navi" as Apollo's navigation mode has it, with
  /// what it says otherwise for some. Throws std::invalid_argument where a name is not known or the network
  /// for mlp is not there.
  explicit SelectionTable(const PredictionConfig& config, std::shared_ptr<const Network> network = nullptr);

  const Service& find(RoadUserType type, Surrounding surrounding) const;
  const Evaluator& evaluator(const std::string& name) const { return *evaluators_.at(name); }
  const Predictor& predictor(const std::string& name) const { return *predictors_.at(name); }

 private:
  struct Key {
    RoadUserType type;
    Surrounding surrounding;
    bool operator<(const Key& other) const {
      return std::tie(type, surrounding) < std::tie(other.type, other.surrounding);
    }
  };

  std::map<Key, Service> services_;
  std::map<std::string, std::unique_ptr<Evaluator>> evaluators_;
  std::map<std::string, std::unique_ptr<Predictor>> predictors_;
};

}  // namespace relative_map::core
