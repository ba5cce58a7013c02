#include "relative_map/model/prediction_config.hpp"

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

}  // namespace

std::vector<std::string> PredictionConfig::validate() const {
  std::vector<std::string> faults;
  // Every number is a distance, a time, a share or a count: none of them can be 0 or less.
  visit_parameters(*this, [&](const std::string& name, const auto& value) {
    if constexpr (std::is_same_v<std::decay_t<decltype(value)>, double>) {
      if (!(value > 0.0 && value < 1e6)) faults.push_back(fault(name, value, "above 0 and below 1e6"));
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
