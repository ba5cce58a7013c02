#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

namespace {

constexpr double kWidthMargin = 1.5;  // a lane so much wider or narrower than the limits is no lane

Cubic mean_of(const LaneMarker& left, const LaneMarker& right) {
  const Cubic &l = left.cubic, &r = right.cubic;
  const double weight = left.quality / (left.quality + right.quality);
  const auto mean = [weight](double a, double b) { return weight * a + (1.0 - weight) * b; };
  return {0.5 * (l.c0 + r.c0), mean(l.c1, r.c1), mean(l.c2, r.c2), mean(l.c3, r.c3)};
}

/// Both markers; a sentence if the lane between them can't be one.
std::variant<Guide, std::string> between(const LaneMarker& left, const LaneMarker& right,
                                         const NavigationLaneParam& param) {
  Guide guide;
  guide.cubic = mean_of(left, right);
  guide.from = std::max(left.longitude_start, right.longitude_start);
  guide.to = std::min(left.view_range, right.view_range);
  // From the center of the lane, square to it: c0 is measured along y.
  const double half_width = 0.5 * (left.cubic.c0 - right.cubic.c0) / std::hypot(1.0, guide.cubic.c1);
  if (half_width < param.min_lane_half_width / kWidthMargin ||
      half_width > param.max_lane_half_width * kWidthMargin) {
    std::ostringstream reason;
    reason << "they are " << 2.0 * half_width << " m apart, left of right positive: no lane";
    return reason.str();
  }
  guide.left_half_width = guide.right_half_width =
      std::clamp(half_width, param.min_lane_half_width, param.max_lane_half_width);
  return guide;
}

Guide beside(const LaneMarker& marker, double offset, const MapParam& map_param) {
  return {marker.cubic,
          offset,
          marker.longitude_start,
          marker.view_range,
          map_param.default_left_width,
          map_param.default_right_width};
}

std::variant<Guide, std::string> guide_of(const LaneMarkers& markers, const MapParam& map_param,
                                          const NavigationLaneParam& param) {
  const std::optional<std::string> left = fault_of(markers.left, param),
                                   right = fault_of(markers.right, param);
  if (!left && !right) return between(markers.left, markers.right, param);
  if (!left) return beside(markers.left, -map_param.default_left_width, map_param);
  if (!right) return beside(markers.right, map_param.default_right_width, map_param);
  return "left: " + *left + "; right: " + *right;
}

}  // namespace

std::variant<MarkerPath, std::string> make_marker_path(const LaneMarkers& markers,
                                                       const Pose2& base_from_sensor, double speed,
                                                       const MapParam& map_param,
                                                       const NavigationLaneParam& param) {
  const std::variant<Guide, std::string> found = guide_of(markers, map_param, param);
  if (const auto* reason = std::get_if<std::string>(&found)) return *reason;
  MarkerPath result = follow(std::get<Guide>(found), base_from_sensor, speed, param);
  if (!fault_of(markers.left, param)) result.left_paint = markers.left.type;
  if (!fault_of(markers.right, param)) result.right_paint = markers.right.type;
  return result;
}

}  // namespace relative_map::core
