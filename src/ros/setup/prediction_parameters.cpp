#include "relative_map/ros/setup/prediction_parameters.hpp"

#include <set>
#include <stdexcept>

#include "relative_map/io/text.hpp"
#include "relative_map/prediction/evaluators/mlp_evaluator.hpp"

namespace relative_map {

namespace {

const std::string kGroup = "prediction/";

bool assign(const Parameter& parameter, double& value) {
  if (const double* number = std::get_if<double>(&parameter)) {
    value = *number;
  } else if (const int* integer = std::get_if<int>(&parameter)) {
    value = *integer;
  } else {
    return false;
  }
  return true;
}

bool assign(const Parameter& parameter, std::string& value) {
  const std::string* text = std::get_if<std::string>(&parameter);
  if (text != nullptr) value = *text;
  return text != nullptr;
}

const char* kind_of(double) {
  return "a number";
}
const char* kind_of(const std::string&) {
  return "text";
}

}  // namespace

PredictionNodeConfig make_prediction_config(const ParameterSet& parameters) {
  PredictionNodeConfig config;
  std::vector<std::string> faults;
  std::set<std::string> known;
  const auto read = [&](const std::string& name, auto& value) {
    known.insert(name);
    const auto found = parameters.find(name);
    if (found != parameters.end() && !assign(found->second, value)) {
      faults.push_back(name + " must be " + kind_of(value));
    }
  };
  core::visit_parameters(config.prediction,
                         [&](const std::string& name, auto& value) { read(kGroup + name, value); });
  std::string convention = "flu", output = "base";
  read("rate", config.rate);
  read("base_frame", config.base_frame);
  read("output_frame", output);
  read("orientation_convention", convention);
  read("max_age/localization", config.max_localization_age);
  read("max_age/map", config.max_map_age);
  config.publish_in_map_frame = output == "map";
  config.orientation_convention =
      convention == "rfu" ? OrientationConvention::kRfu : OrientationConvention::kFlu;

  for (const auto& [name, unused] : parameters) {
    if (known.count(name) == 0) faults.push_back(name + " is not a parameter of prediction");
  }
  const auto demand = [&](bool met, const std::string& sentence) {
    if (!met) faults.push_back(sentence);
  };
  demand(config.rate > 0.0 && config.rate <= 1000.0, "rate must be above 0 and at most 1000 Hz");
  demand(!config.base_frame.empty(), "base_frame must not be empty");
  demand(output == "base" || output == "map", "output_frame is '" + output + "', but must be base or map");
  demand(convention == "flu" || convention == "rfu",
         "orientation_convention is '" + convention + "', but must be flu or rfu");
  demand(config.max_localization_age > 0.0, "max_age/localization must be above 0 s");
  demand(config.max_map_age > 0.0, "max_age/map must be above 0 s");
  for (const std::string& fault : config.prediction.validate()) faults.push_back(kGroup + fault);
  if (faults.empty()) return config;
  std::string text = "the configuration is refused:";
  for (const std::string& fault : faults) text += "\n  - " + fault;
  throw std::runtime_error(text);
}

std::shared_ptr<const core::Network> load_network(const core::PredictionConfig& config) {
  if (config.network.empty()) return nullptr;
  return std::make_shared<const core::Network>(
      core::Network::parse(core::read_text(config.network), config.network, core::way_features()));
}

}  // namespace relative_map
