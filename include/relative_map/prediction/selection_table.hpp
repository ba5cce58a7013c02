#pragma once

#include <map>
#include <memory>
#include <string>
#include <tuple>

#include "relative_map/prediction/evaluators/evaluator.hpp"
#include "relative_map/prediction/predictors/predictor.hpp"

namespace relative_map::core {

/// Where a road user is.
enum class Surrounding { kOnLane, kOffLane };

/// Who is served by what.
struct Service {
  std::string evaluator, predictor;
};

/// Which evaluator and which predictor serve a road user.
class SelectionTable {
 public:
  /// A preset: "default", or "navi" as Apollo's navigation mode has it. Throws std::invalid_argument for
  /// others.
  explicit SelectionTable(const std::string& preset);

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
