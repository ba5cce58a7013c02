#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

namespace {

constexpr double kStep = 1.0;         // [m] between samples
constexpr double kStart = -2.0;       // [m] x of the first sample
constexpr double kFadeLength = 30.0;  // [m] past view_range until the path runs straight
constexpr double kWidthMargin = 1.5;  // a lane so much wider or narrower than the limits is no lane

/// The curve that the path follows, and how far it may be believed.
struct Guide {
  Cubic cubic;
  double offset = 0.0;          ///< [m] of the path from the cubic, left positive
  double from = 0.0, to = 0.0;  ///< [m] x
  double left_half_width = 0.0, right_half_width = 0.0;
};

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

/// The path beside the cubic at x: a parallel curve, kappa' = kappa / (1 - offset kappa).
PathPoint sample(const Guide& guide, double x) {
  PathPoint point;
  point.theta = std::atan(guide.cubic.slope(x));
  point.direction = {std::cos(point.theta), std::sin(point.theta)};
  point.position = Point2(x, guide.cubic.value(x)) + guide.offset * left_of(point.direction);
  const double kappa = guide.cubic.kappa(x);
  point.kappa = kappa / (1.0 - guide.offset * kappa);
  return point;
}

/// Goes on from the last point for `length` [m] with a curvature that fades to zero.
void extend(PathPoints& points, double length) {
  const double kappa = points.back().kappa;
  double theta = points.back().theta;
  for (double u = 0.0; u < length; u += kStep) {
    const auto fade = [](double t) { return t < 1.0 ? (1.0 - t) * (1.0 - t) * (1.0 + 2.0 * t) : 0.0; };
    const double turn = kStep * kappa * fade((u + 0.5 * kStep) / kFadeLength);
    const double middle = theta + 0.5 * turn;
    theta = normalize_angle(theta + turn);
    PathPoint point;
    point.position = points.back().position + kStep * Point2(std::cos(middle), std::sin(middle));
    point.theta = theta;
    point.direction = {std::cos(theta), std::sin(theta)};
    point.kappa = kappa * fade((u + kStep) / kFadeLength);
    points.push_back(point);
  }
}

void compute_dkappa(PathPoints& points) {
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint &a = points[i == 0 ? 0 : i - 1], &b = points[std::min(i + 1, points.size() - 1)];
    points[i].dkappa = (b.kappa - a.kappa) / (b.s - a.s);
  }
}

void move_to_base(PathPoints& points, const Pose2& base_from_sensor) {
  for (PathPoint& point : points) {
    point.position = base_from_sensor.to_parent(point.position);
    point.direction = base_from_sensor.rotate_to_parent(point.direction);
    point.theta = normalize_angle(point.theta + base_from_sensor.heading());
  }
}

/// Along the guide, which is given in a frame that lies in the body as `base_from_sensor` says.
MarkerPath follow(const Guide& guide, const Pose2& base_from_sensor, double speed,
                  const NavigationLaneParam& param) {
  const double length = std::clamp(std::abs(speed) * param.ratio_navigation_lane_len_to_speed,
                                   param.min_len_for_navigation_lane, param.max_len_for_navigation_lane);
  const double seen = std::min(guide.to, length);
  // A camera ahead of the base, or a vehicle that has rolled back since: the path starts behind it all the
  // same.
  const double start = kStart - std::ceil(std::max(0.0, base_from_sensor.position().x()) / kStep) * kStep;
  MarkerPath result;
  LanePath& path = result.path;
  std::size_t first_trusted = 0;
  for (double x = start; x <= std::max(seen, start + kStep); x += kStep) {
    if (x < guide.from) ++first_trusted;
    path.points.push_back(sample(guide, x));
  }
  const std::size_t last_trusted = path.points.size() - 1;
  extend(path.points, length - (start + kStep * static_cast<double>(last_trusted)));
  compute_arc_length(path.points);
  compute_dkappa(path.points);
  result.trusted_from = path.points[std::min(first_trusted, last_trusted)].s;
  result.trusted_to = path.points[last_trusted].s;

  move_to_base(path.points, base_from_sensor);
  path.id = path.name = "lane_markers";
  path.left_half_width = guide.left_half_width;
  path.right_half_width = guide.right_half_width;
  locate_vehicle(path);
  path.remaining = path.points.back().s - path.s_at_vehicle;
  return result;
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

MarkerPath make_marker_path(const Cubic& centerline, const Pose2& base_from_frame, double seen_to,
                            double left_half_width, double right_half_width, double speed,
                            const NavigationLaneParam& param) {
  return follow({centerline, 0.0, 0.0, seen_to, left_half_width, right_half_width}, base_from_frame, speed,
                param);
}

}  // namespace relative_map::core
