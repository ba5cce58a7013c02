#include "relative_map/pipeline/lanes/current_lane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relative_map::core {

namespace {

constexpr double kHysteresis = 0.3;  // [m] by which another lane must be nearer to become the current one

/// `s` [m] is negative before the start.
double distance_to(double l, double s, bool is_current) {
  return std::hypot(l, std::max(0.0, -s)) - (is_current ? kHysteresis : 0.0);
}

}  // namespace

std::size_t choose_current(const std::vector<LanePath>& lanes, const std::string& current_id) {
  const auto distance = [&](const LanePath& lane) {
    return distance_to(lane.l, lane.s_at_vehicle, lane.id == current_id);
  };
  const auto nearest =
      std::min_element(lanes.begin(), lanes.end(),
                       [&](const LanePath& a, const LanePath& b) { return distance(a) < distance(b); });
  return static_cast<std::size_t>(nearest - lanes.begin());
}

const TrackedLine& choose_current(const std::vector<TrackedLine>& lines, const std::string& current_id) {
  const auto distance = [&](const TrackedLine& tracked) {
    return distance_to(tracked.projection.l, tracked.projection.s, tracked.line->id == current_id);
  };
  return *std::min_element(lines.begin(), lines.end(), [&](const TrackedLine& a, const TrackedLine& b) {
    return distance(a) < distance(b);
  });
}

double expected_half_width(const std::vector<TrackedLine>& lines, const TrackedLine& current,
                           const NavigationLaneParam& param, double otherwise) {
  double nearest = std::numeric_limits<double>::max();
  for (const TrackedLine& line : lines) {
    const double spacing = std::abs(line.projection.l - current.projection.l);
    if (spacing >= 2.0 * param.min_lane_half_width) nearest = std::min(nearest, spacing);
  }
  return nearest <= 2.0 * param.max_lane_half_width ? 0.5 * nearest : otherwise;
}

}  // namespace relative_map::core
