#pragma once

#include <memory>
#include <string>

#include "relative_map/model/prediction_config.hpp"
#include "relative_map/prediction/network.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

/// All that the prediction node can be told. Defaults as in config/prediction.yaml.
struct PredictionNodeConfig {
  core::PredictionConfig prediction;     ///< below "prediction/"
  double rate = 10.0;                    ///< [Hz] at which it looks for new obstacles
  std::string base_frame = "base_link";  ///< body frame
  bool publish_in_map_frame = false;     ///< else in the body frame at the obstacles' stamp
  double max_localization_age = 0.5;     ///< [s]
  double max_map_age = 1.0;              ///< [s] an older map is not used
  OrientationConvention orientation_convention = OrientationConvention::kFlu;
};

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
PredictionNodeConfig make_prediction_config(const ParameterSet& parameters);

/// The network that the configuration names, for the evaluator mlp; none, if it names none. Throws
/// std::runtime_error where it can't be read or is refused.
std::shared_ptr<const core::Network> load_network(const core::PredictionConfig& config);

}  // namespace relative_map
