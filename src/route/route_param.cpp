#include "relative_map/route/route_param.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/model/check_range.hpp"

namespace relative_map::core {

namespace {

constexpr double kRamp = 1.5;  // [m/s] over which look_ahead rises to look_ahead_fast

}  // namespace

std::vector<std::string> RouteParam::validate() const {
  std::vector<std::string> faults;
  check_range("max_distance", max_distance, 0.5, 100.0, faults);
  check_range("max_heading", max_heading, 0.1, 3.1416, faults);
  check_range("look_back", look_back, 0.0, 1000.0, faults);
  check_range("look_ahead", look_ahead, 10.0, 5000.0, faults);
  check_range("look_ahead_fast", look_ahead_fast, look_ahead, 5000.0, faults);
  check_range("look_ahead_time", look_ahead_time, 0.0, 60.0, faults);
  check_range("max_lane_change_distance", max_lane_change_distance, 0.0, 100.0, faults);
  check_range("lane_gap", lane_gap, 0.0, 10.0, faults);
  return faults;
}

double RouteParam::ahead(double speed) const {
  const double v = std::isfinite(speed) ? std::max(speed, 0.0) : 0.0;
  const double fast = look_ahead_time > 0.0 ? look_ahead / look_ahead_time : INFINITY;  // [m/s]
  const double share = std::clamp((v - fast) / kRamp, 0.0, 1.0);
  return std::max(look_ahead + share * (look_ahead_fast - look_ahead), look_ahead_time * v);
}

}  // namespace relative_map::core
