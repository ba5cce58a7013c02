#include "relative_map/pipeline/lane_fusion.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

/// Marker path seen from the line at one place: along its tangent, to its left, in heading.
struct Offset {
  Point2 ahead_and_left;
  double heading;
};

/// Looks both up at the same arc length from the vehicle.
class OffsetAlong {
 public:
  OffsetAlong(const LanePath& line, const LanePath& markers) : line_(line), markers_(markers) {}

  Offset at(double from_vehicle) {
    const PathPoint on_line = interpolate(line_.points, line_.s_at_vehicle + from_vehicle, line_hint_);
    return seen_from(on_line, from_vehicle);
  }
  Offset seen_from(const PathPoint& on_line, double from_vehicle) {
    const PathPoint on_markers =
        interpolate(markers_.points, markers_.s_at_vehicle + from_vehicle, markers_hint_);
    const Point2 gap = on_markers.position - on_line.position;
    return {{on_line.direction.dot(gap), cross(on_line.direction, gap)},
            angle_difference(on_markers.theta, on_line.theta)};
  }

 private:
  const LanePath& line_;
  const LanePath& markers_;
  std::size_t line_hint_ = 0;
  std::size_t markers_hint_ = 0;
};

/// From a value and slope at u = 0 to rest at u = length, by the quintic without curvature at either end.
Point2 fade_out(const Point2& value, const Point2& slope, double u, double length) {
  const double t = u / length;
  if (t >= 1.0) return Point2::Zero();
  const double t3 = t * t * t;
  return value * (1.0 - t3 * (10.0 - t * (15.0 - 6.0 * t))) +
         slope * length * (t - t3 * (6.0 - t * (8.0 - 3.0 * t)));
}

}  // namespace

FusionState fuse_fixed_weight(const MarkerPath& markers, double weight, double fade_length, LanePath& lane) {
  const LanePath line = lane;
  OffsetAlong offset(line, markers.path);
  const double from = markers.trusted_from - markers.path.s_at_vehicle;
  const double to = markers.trusted_to - markers.path.s_at_vehicle;
  const Offset at_vehicle = offset.at(std::clamp(0.0, from, to));
  const Offset at_start = offset.at(from);
  const Point2 at_end = offset.at(to).ahead_and_left;
  const double step = std::min(1.0, to - from);
  const Point2 slope_at_end =
      step > 0.0 ? Point2((at_end - offset.at(to - step).ahead_and_left) / step) : Point2(Point2::Zero());

  for (PathPoint& point : lane.points) {
    const double from_vehicle = point.s - line.s_at_vehicle;
    Point2 correction;
    if (from_vehicle < from) {
      correction = at_start.ahead_and_left;
    } else if (from_vehicle <= to) {
      correction = offset.seen_from(point, from_vehicle).ahead_and_left;
    } else {
      correction = fade_out(at_end, slope_at_end, from_vehicle - to, fade_length);
    }
    point.position += weight * (correction.x() * point.direction + correction.y() * left_of(point.direction));
  }
  compute_arc_length(lane.points);
  compute_geometry(lane.points);
  locate_vehicle(lane);
  lane.left_half_width = markers.path.left_half_width;
  lane.right_half_width = markers.path.right_half_width;

  FusionState state;
  state.source = Source::kFused;
  state.method = "fixed_weight";
  state.lateral_offset.value = weight * at_vehicle.ahead_and_left.y();
  state.heading_offset.value = weight * at_vehicle.heading;
  state.marker_range = std::max(0.0, to);
  return state;
}

}  // namespace relative_map::core
