#include "relative_map/ros/route/route_parameters.hpp"

#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace relative_map {

namespace {

/// Takes parameters by name, and keeps account of what was asked for and what was wrong.
class Taker {
 public:
  explicit Taker(const ParameterSet& parameters) : parameters_(parameters) {}

  void take(const std::string& name, double& value) {
    if (const Parameter* found = find(name)) {
      if (const double* number = std::get_if<double>(found)) {
        value = *number;
      } else if (const int* integer = std::get_if<int>(found)) {
        value = *integer;
      } else {
        faults.push_back(name + " must be a number");
      }
    }
  }
  void take(const std::string& name, std::string& value) {
    if (const Parameter* found = find(name)) {
      if (const std::string* text = std::get_if<std::string>(found)) {
        value = *text;
      } else {
        faults.push_back(name + " must be text");
      }
    }
  }
  template <class Enum>
  void take(const std::string& name, Enum& value, const std::vector<std::pair<std::string, Enum>>& words) {
    std::string word;
    take(name, word);
    if (find(name) == nullptr || word.empty()) return;
    std::string choice;
    for (const auto& [known, meaning] : words) {
      if (word == known) {
        value = meaning;
        return;
      }
      choice += (choice.empty() ? "" : " or ") + known;
    }
    faults.push_back(name + " is '" + word + "', but must be " + choice);
  }
  void expect(const std::string& name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream text;
    text << name << " is " << value << ", but must lie in [" << low << ", " << high << "]";
    faults.push_back(text.str());
  }
  void add(const std::string& group, const std::vector<std::string>& found) {
    for (const std::string& fault : found) faults.push_back(group + "/" + fault);
  }
  void name_unknown() {
    for (const auto& [name, value] : parameters_) {
      if (known_.count(name) == 0) faults.push_back(name + " is not a parameter of this node");
    }
  }

  std::vector<std::string> faults;

 private:
  const Parameter* find(const std::string& name) {
    known_.insert(name);
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? nullptr : &found->second;
  }

  const ParameterSet& parameters_;
  std::set<std::string> known_;
};

void take_route(Taker& taker, core::RouteParam& route) {
  taker.take("route/max_distance", route.max_distance);
  taker.take("route/max_heading", route.max_heading);
  taker.take("route/look_back", route.look_back);
  taker.take("route/look_ahead", route.look_ahead);
  taker.take("route/look_ahead_fast", route.look_ahead_fast);
  taker.take("route/look_ahead_time", route.look_ahead_time);
  taker.take("route/max_lane_change_distance", route.max_lane_change_distance);
  taker.take("route/lane_gap", route.lane_gap);
  taker.add("route", route.validate());
}

void take_line(Taker& taker, core::ReferenceLineParam& line) {
  taker.take("reference_line/spacing", line.spacing);
  taker.take("reference_line/vehicle_width", line.vehicle_width);
  taker.take("reference_line/half_width", line.half_width);
  taker.take("reference_line/clearance", line.clearance);
  taker.take("reference_line/curb_clearance", line.curb_clearance);
  taker.take("reference_line/curb_shift", line.curb_shift);
  taker.take("reference_line/least_bound", line.least_bound);
  taker.take("reference_line/greatest_bound", line.greatest_bound);
  taker.take("reference_line/follow", line.follow);
  taker.take("reference_line/pinned", line.pinned);
  taker.take("reference_line/speed_limit", line.speed_limit);
  taker.take("reference_line/lateral_acceleration", line.lateral_acceleration);
  taker.add("reference_line", line.validate());
}

void take_search(Taker& taker, core::SearchParam& search) {
  taker.take("search/base_speed", search.base_speed);
  taker.take("search/left_turn", search.left_turn);
  taker.take("search/right_turn", search.right_turn);
  taker.take("search/u_turn", search.u_turn);
  taker.take("search/lane_change", search.lane_change);
  taker.take("search/lane_change_length", search.lane_change_length);
  taker.take("search/least_change_length", search.least_change_length);
  taker.take("search/min_turn_radius", search.min_turn_radius);
  taker.add("search", search.validate());
}

}  // namespace

RouteNodeConfig make_route_config(const ParameterSet& parameters) {
  RouteNodeConfig config;
  Taker taker(parameters);
  taker.take("source", config.source,
             {{"lane_graph", RouteSource::kLaneGraph}, {"relative_map", RouteSource::kRelativeMap}});
  taker.take("orientation_convention", config.orientation_convention,
             {{"flu", OrientationConvention::kFlu}, {"rfu", OrientationConvention::kRfu}});
  taker.take("rate", config.rate);
  taker.take("lane_graph", config.lane_graph);
  taker.take("base_frame", config.base_frame);
  taker.take("max_age/localization", config.max_age_localization);
  taker.take("max_age/chassis", config.max_age_chassis);
  taker.take("max_age/relative_map", config.max_age_relative_map);
  taker.expect("rate", config.rate, 0.1, 1000.0);
  taker.expect("max_age/localization", config.max_age_localization, 0.01, 1e9);
  taker.expect("max_age/chassis", config.max_age_chassis, 0.01, 1e9);
  taker.expect("max_age/relative_map", config.max_age_relative_map, 0.01, 1e9);
  if (config.base_frame.empty()) taker.faults.push_back("base_frame must not be empty");
  take_route(taker, config.route);
  take_line(taker, config.reference_line);
  take_search(taker, config.search);
  taker.name_unknown();
  if (taker.faults.empty()) return config;
  std::string all = "bad parameters:";
  for (const std::string& fault : taker.faults) all += "\n  " + fault;
  throw std::runtime_error(all);
}

}  // namespace relative_map
