#include "relative_map/pipeline/lanes/marker_path.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kStep = 1.0;         // [m] between samples
constexpr double kStart = -2.0;       // [m] x of the first sample
constexpr double kFadeLength = 30.0;  // [m] past view_range until the path runs straight

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

}  // namespace

MarkerPath follow(const Guide& guide, const Pose2& base_from_frame, double speed,
                  const NavigationLaneParam& param) {
  const double length = std::clamp(std::abs(speed) * param.ratio_navigation_lane_len_to_speed,
                                   param.min_len_for_navigation_lane, param.max_len_for_navigation_lane);
  const double seen = std::min(guide.to, length);
  // A camera ahead of the base, or a vehicle that has rolled back since: the path starts behind it all the
  // same.
  const double start = kStart - std::ceil(std::max(0.0, base_from_frame.position().x()) / kStep) * kStep;
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

  move_to_base(path.points, base_from_frame);
  path.id = path.name = "lane_markers";
  path.left_half_width = guide.left_half_width;
  path.right_half_width = guide.right_half_width;
  locate_vehicle(path);
  path.remaining = path.points.back().s - path.s_at_vehicle;
  return result;
}

}  // namespace relative_map::core
