#include "relative_map/route/route_param.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kRamp = 1.5;  // [m/s] over which look_ahead rises to look_ahead_fast

}  // namespace

std::vector<std::string> RouteParam::validate() const {
  std::vector<std::string> faults;
  const auto expect = [&](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream text;
    text << name << " is " << value << ", but must lie in [" << low << ", " << high << "]";
    faults.push_back(text.str());
  };
  expect("max_distance", max_distance, 0.5, 100.0);
  expect("max_heading", max_heading, 0.1, 3.1416);
  expect("look_back", look_back, 0.0, 1000.0);
  expect("look_ahead", look_ahead, 10.0, 5000.0);
  expect("look_ahead_fast", look_ahead_fast, look_ahead, 5000.0);
  expect("look_ahead_time", look_ahead_time, 0.0, 60.0);
  expect("max_lane_change_distance", max_lane_change_distance, 0.0, 100.0);
  expect("lane_gap", lane_gap, 0.0, 10.0);
  return faults;
}

double RouteParam::ahead(double speed) const {
  const double v = std::isfinite(speed) ? std::max(speed, 0.0) : 0.0;
  const double fast = look_ahead_time > 0.0 ? look_ahead / look_ahead_time : INFINITY;  // [m/s]
  const double share = std::clamp((v - fast) / kRamp, 0.0, 1.0);
  return std::max(look_ahead + share * (look_ahead_fast - look_ahead), look_ahead_time * v);
}

}  // namespace relative_map::core
