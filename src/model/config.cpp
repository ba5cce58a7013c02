#include "relative_map/model/config.hpp"

#include <cmath>
#include <limits>
#include <sstream>

namespace relative_map::core {

namespace {

/// Collects a sentence for each number that is out of its bounds.
class Faults {
 public:
  /// `low` itself is allowed; NaN never is.
  void at_least(const char* name, double value, double low) { range(name, value, low, kNoLimit); }
  void positive(const char* name, double value) {
    if (!(value > 0.0) || !std::isfinite(value)) add(name, value, "must be above 0");
  }
  void range(const char* name, double value, double low, double high) {
    if (value >= low && value <= high && std::isfinite(value)) return;
    std::ostringstream rule;
    if (std::isfinite(high)) {
      rule << "must lie in [" << low << ", " << high << "]";
    } else {
      rule << "must be at least " << low;
    }
    add(name, value, rule.str());
  }
  void ordered(const char* low_name, double low, const char* high_name, double high) {
    if (low > high) add(low_name, low, std::string("must not exceed ") + high_name);
  }
  void add(const std::string& sentence) { faults_.push_back(sentence); }
  std::vector<std::string> take() { return std::move(faults_); }

 private:
  static constexpr double kNoLimit = std::numeric_limits<double>::infinity();

  void add(const char* name, double value, const std::string& rule) {
    std::ostringstream sentence;
    sentence << name << " is " << value << ", but " << rule;
    faults_.push_back(sentence.str());
  }

  std::vector<std::string> faults_;
};

}  // namespace

std::vector<std::string> PipelineConfig::validate() const {
  Faults faults;
  faults.range("map_param/default_left_width", map_param.default_left_width, 0.5, 10.0);
  faults.range("map_param/default_right_width", map_param.default_right_width, 0.5, 10.0);
  faults.range("map_param/default_speed_limit", map_param.default_speed_limit, 0.1, 100.0);

  const NavigationLaneParam& lane = navigation_lane;
  faults.range("navigation_lane/max_len_from_navigation_line", lane.max_len_from_navigation_line, 1.0, 1e5);
  faults.range("navigation_lane/min_len_for_navigation_lane", lane.min_len_for_navigation_lane, 1.0, 1e4);
  faults.range("navigation_lane/max_len_for_navigation_lane", lane.max_len_for_navigation_lane, 1.0, 1e4);
  faults.ordered("navigation_lane/min_len_for_navigation_lane", lane.min_len_for_navigation_lane,
                 "navigation_lane/max_len_for_navigation_lane", lane.max_len_for_navigation_lane);
  faults.positive("navigation_lane/ratio_navigation_lane_len_to_speed",
                  lane.ratio_navigation_lane_len_to_speed);
  faults.range("navigation_lane/max_distance_to_navigation_line", lane.max_distance_to_navigation_line, 0.1,
               1e3);
  faults.at_least("navigation_lane/min_view_range_to_use_lane_marker", lane.min_view_range_to_use_lane_marker,
                  0.0);
  faults.range("navigation_lane/min_lane_marker_quality", lane.min_lane_marker_quality, 0.0, 1.0);
  faults.range("navigation_lane/min_lane_half_width", lane.min_lane_half_width, 0.5, 10.0);
  faults.range("navigation_lane/max_lane_half_width", lane.max_lane_half_width, 0.5, 10.0);
  faults.ordered("navigation_lane/min_lane_half_width", lane.min_lane_half_width,
                 "navigation_lane/max_lane_half_width", lane.max_lane_half_width);
  faults.range("navigation_lane/lane_marker_weight", lane.lane_marker_weight, 0.0, 1.0);

  if (lane_fusion.method != "estimator" && lane_fusion.method != "fixed_weight") {
    faults.add("lane_fusion/method is '" + lane_fusion.method + "', but must be estimator or fixed_weight");
  }
  faults.range("lane_fusion/max_offset", lane_fusion.max_offset, 0.0, 1e3);
  faults.range("lane_fusion/decay_time", lane_fusion.decay_time, 0.1, 1e4);
  faults.range("lane_fusion/hold_time", lane_fusion.hold_time, 0.0, 60.0);
  faults.range("lane_fusion/fade_length", lane_fusion.fade_length, 10.0, 1e3);

  faults.positive("max_age/localization", max_age.localization);
  faults.positive("max_age/chassis", max_age.chassis);
  faults.positive("max_age/lane_markers", max_age.lane_markers);

  if (base_frame.empty()) faults.add("base_frame is empty");
  faults.range("footprint/half_width", footprint.half_width, 0.1, 5.0);
  faults.range("footprint/front_overhang", footprint.front_overhang, 0.0, 50.0);
  faults.range("footprint/rear_overhang", footprint.rear_overhang, 0.0, 50.0);
  return faults.take();
}

}  // namespace relative_map::core
