#include "relative_map/pipeline/lines/current_lane.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace relative_map::core {

namespace {

constexpr double kHysteresis = 0.3;  // [m] by which another lane must be nearer to become the current one
constexpr double kAlong = 0.25;      // [rad] that a vehicle is askew in its lane: changing lanes at low speed
constexpr double kMetersPerRadian = 5.0;  // beyond that, so much heading weighs as much as a metre
constexpr double kSameWay = 0.25;         // [rad] between lines that run beside each other

/// [m] The lower, the rather the vehicle is on the line. Where a road crosses, it is for a moment as near as
/// the own one: its heading tells.
double cost_of(const LineProjection& place, bool is_current) {
  const double distance = std::hypot(place.l, std::max(0.0, -place.s));  // s is negative before the start
  const double askew = std::max(0.0, std::abs(place.heading_offset) - kAlong);
  return distance + kMetersPerRadian * askew - (is_current ? kHysteresis : 0.0);
}

}  // namespace

std::size_t choose_current(const std::vector<TrackedLine>& lines, const std::string& current_id) {
  const auto cost = [&](const TrackedLine& tracked) {
    return cost_of(tracked.projection, tracked.line->id == current_id);
  };
  const auto best =
      std::min_element(lines.begin(), lines.end(),
                       [&](const TrackedLine& a, const TrackedLine& b) { return cost(a) < cost(b); });
  return static_cast<std::size_t>(best - lines.begin());
}

double expected_half_width(const std::vector<TrackedLine>& lines, const TrackedLine& current,
                           const NavigationLaneParam& param, double otherwise) {
  double nearest = std::numeric_limits<double>::max();
  for (const TrackedLine& line : lines) {
    const double turned = angle_difference(line.projection.heading_offset, current.projection.heading_offset);
    const double spacing = std::abs(line.projection.l - current.projection.l);
    const bool beside = line.projection.s >= 0.0 && std::abs(turned) <= kSameWay;
    if (beside && spacing >= 2.0 * param.min_lane_half_width) nearest = std::min(nearest, spacing);
  }
  return nearest <= 2.0 * param.max_lane_half_width ? 0.5 * nearest : otherwise;
}

}  // namespace relative_map::core
