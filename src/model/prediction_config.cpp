#include "relative_map/model/prediction_config.hpp"

#include <set>
#include <sstream>
#include <type_traits>

namespace relative_map::core {

namespace {

std::string fault(const std::string& name, double value, const std::string& demand) {
  std::ostringstream text;
  text << name << " is " << value << ", but must be " << demand;
  return text.str();
}

std::string fault(const std::string& name, const std::string& value, const std::string& demand) {
  return name + " is '" + value + "', but must be " + demand;
}

struct Missing {
  const char* name;
  const char* what;
};
// Evaluators that the published original has and that nobody can run: their features are made here, their
// weights are not to be had.
constexpr Missing kMissing[] = {
    {"semantic_lstm",
     "its weights, which were never published; features/lane_raster and history_features are its input"},
    {"vectornet",
     "its weights, which were never published; features/lane_polylines and history_features are its input"},
    {"jointly",
     "its weights, which were never published; vectornet's features and features/ego_features are its input"},
    {"multi_agent",
     "its weights, which were never published; vectornet's features of all road users are its input"},
    {"junction_map", "its weights, which were never published; features/lane_raster is its input"},
};

void check_evaluator(const std::string& key, const std::string& name, bool has_network,
                     std::vector<std::string>& faults) {
  for (const Missing& missing : kMissing) {
    if (name == missing.name) {
      faults.push_back(key + " is '" + name + "', for which something is missing: " + missing.what);
      return;
    }
  }
  if (name == "mlp") {
    if (!has_network) faults.push_back(key + " is 'mlp', but network names no file of weights");
  } else if (!name.empty() && name != "cost" && name != "keep_lane") {
    faults.push_back(key + " is '" + name + "', but must be cost, keep_lane, mlp or empty");
  }
}

void check_predictor(const std::string& key, const std::string& name, std::vector<std::string>& faults) {
  static const std::set<std::string> kNames = {"",          "single_lane",   "lane_sequence", "move_sequence",
                                               "free_move", "extrapolation", "regional",      "interaction",
                                               "empty"};
  if (kNames.count(name) > 0) return;
  faults.push_back(
      key + " is '" + name +
      "', but must be single_lane, lane_sequence, move_sequence, free_move, extrapolation, regional, "
      "interaction, empty or nothing");
}

bool ends_with(const std::string& text, const std::string& end) {
  return text.size() >= end.size() && text.compare(text.size() - end.size(), end.size(), end) == 0;
}

}  // namespace

std::vector<std::string> PredictionConfig::validate() const {
  std::vector<std::string> faults;
  // Every number is a distance, a time, a share or a count: none of them can be 0 or less.
  visit_parameters(*this, [&](const std::string& name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      if (!(value > 0.0 && value < 1e6)) faults.push_back(fault(name, value, "above 0 and below 1e6"));
    } else if (ends_with(name, "/evaluator")) {
      check_evaluator(name, value, !network.empty(), faults);
    } else if (ends_with(name, "/predictor")) {
      check_predictor(name, value, faults);
    }
  });
  if (filter.preset != "singer" && filter.preset != "seed") {
    faults.push_back(fault("filter/preset", filter.preset, "singer or seed"));
  }
  if (selection != "default" && selection != "navi") {
    faults.push_back(fault("selection", selection, "default or navi"));
  }
  if (speed.max_headway < speed.min_headway) {
    faults.push_back(fault("speed/max_headway", speed.max_headway, "at least speed/min_headway"));
  }
  if (filter.max_position_stddev < filter.min_position_stddev) {
    faults.push_back(fault("filter/max_position_stddev", filter.max_position_stddev,
                           "at least filter/min_position_stddev"));
  }
  if (store.max_road_users > 2000.0) {
    faults.push_back(fault("store/max_road_users", store.max_road_users, "at most 2000"));
  }
  if (lane.max_modes < 1.0) faults.push_back(fault("lane/max_modes", lane.max_modes, "at least 1"));
  if (lane.min_probability > 0.5) {
    faults.push_back(fault("lane/min_probability", lane.min_probability, "at most 0.5"));
  }
  return faults;
}

}  // namespace relative_map::core
