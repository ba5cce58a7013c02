#include "relative_map/prediction/evaluators/mlp_evaluator.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace relative_map::core {

namespace {

constexpr double kLeastLogit = -30.0;

}  // namespace

const std::vector<std::string>& way_features() {
  static const std::vector<std::string> names = {
      "offset", "lateral_speed", "half_width", "inside", "turn", "bend", "braking", "speed", "acceleration"};
  return names;
}

Eigen::VectorXd features_of(const LaneOption& option, const Situation& situation) {
  Eigen::VectorXd features(static_cast<Eigen::Index>(way_features().size()));
  features << option.l, option.lateral_speed, option.half_width, (option.inside() ? 1.0 : 0.0), option.turn,
      option.bend, option.braking, situation.speed, situation.acceleration;
  return features;
}

MlpEvaluator::MlpEvaluator(std::shared_ptr<const Network> network) : network_(std::move(network)) {
  if (network_->outputs() != 1) {
    throw std::runtime_error("a network that evaluates ways must have one output, and this one has " +
                             std::to_string(network_->outputs()));
  }
}

void MlpEvaluator::evaluate(const PredictionContext&, Situation& situation) const {
  std::vector<double> odds;
  double greatest = kLeastLogit;
  for (const LaneOption& option : situation.options) {
    const double logit = network_->run(features_of(option, situation))[0];
    odds.push_back(std::isfinite(logit) ? logit : kLeastLogit);
    greatest = std::max(greatest, odds.back());
  }
  for (double& value : odds) value = std::exp(std::max(kLeastLogit, value - greatest));
  set_probabilities(odds, situation.options);
}

}  // namespace relative_map::core
