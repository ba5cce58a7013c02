#include "relative_map/pipeline/lane_fusion.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr double kSettleLength =
    20.0;  // [m] behind the first paint, over which the slope of the correction ends

/// Where the marker path lies, seen from a place on the line: (along its tangent, to its left), with the
/// first and second derivatives by arc length, and in heading.
struct Offset {
  Point2 value;
  Point2 slope;
  Point2 bend;
  double heading;
};

/// Looks both paths up at the same arc length from the vehicle.
class OffsetAlong {
 public:
  OffsetAlong(const LanePath& line, const LanePath& markers) : line_(line), markers_(markers) {}

  Offset at(double from_vehicle) {
    return seen_from(interpolate(line_.points, line_.s_at_vehicle + from_vehicle, line_hint_), from_vehicle);
  }
  Offset seen_from(const PathPoint& on_line, double from_vehicle) {
    const PathPoint on_markers =
        interpolate_smoothly(markers_.points, markers_.s_at_vehicle + from_vehicle, markers_hint_);
    const Point2 gap = on_markers.position - on_line.position;
    const double ahead = on_line.direction.dot(gap), left = cross(on_line.direction, gap);
    const double along = on_line.direction.dot(on_markers.direction);
    const double across = cross(on_line.direction, on_markers.direction);
    const double kappa = on_line.kappa, turn = on_markers.kappa - kappa;
    // Both go on along their tangents at the same rate, and the frame of the line turns by its curvature.
    const Point2 slope(along - 1.0 + kappa * left, across - kappa * ahead);
    const Point2 bend(-across * turn + kappa * slope.y() + on_line.dkappa * left,
                      along * turn - kappa * slope.x() - on_line.dkappa * ahead);
    return {{ahead, left}, slope, bend, angle_difference(on_markers.theta, on_line.theta)};
  }

 private:
  const LanePath& line_;
  const LanePath& markers_;
  std::size_t line_hint_ = 0;
  std::size_t markers_hint_ = 0;
};

/// The quintic from a value with its derivatives at u = 0 to rest in 0 at u = length.
Point2 fade_out(const Point2& value, const Point2& slope, const Point2& bend, double u, double length) {
  const double t = u / length;
  if (t >= 1.0) return Point2::Zero();
  const double t2 = t * t, t3 = t2 * t;
  return value * (1.0 - t3 * (10.0 - t * (15.0 - 6.0 * t))) +
         slope * length * (t - t3 * (6.0 - t * (8.0 - 3.0 * t))) +
         bend * length * length * 0.5 * (t2 - t3 * (3.0 - t * (3.0 - t)));
}

/// What the line is moved by to become the marker path, at a distance [m] from the vehicle along it.
class Correction {
 public:
  Correction(const LanePath& line, const MarkerPath& markers, double fade_length)
      : offset_(line, markers.path),
        from_(markers.trusted_from - markers.path.s_at_vehicle),
        to_(markers.trusted_to - markers.path.s_at_vehicle),
        fade_length_(fade_length),
        at_start_(offset_.at(from_)),
        at_end_(offset_.at(to_)) {}

  /// (along the line's tangent, to its left) [m]
  Point2 at(const PathPoint& on_line, double from_vehicle) {
    if (from_vehicle < from_) {
      return at_start_.value +
             fade_out(Point2::Zero(), -at_start_.slope, at_start_.bend, from_ - from_vehicle, kSettleLength);
    }
    if (from_vehicle <= to_) return offset_.seen_from(on_line, from_vehicle).value;
    return fade_out(at_end_.value, at_end_.slope, at_end_.bend, from_vehicle - to_, fade_length_);
  }
  /// Beside the vehicle, or at the paint that is nearest to it.
  Offset near_vehicle() { return offset_.at(std::clamp(0.0, from_, to_)); }

 private:
  OffsetAlong offset_;
  double from_, to_;  ///< [m] from the vehicle: where paint was seen
  double fade_length_;
  Offset at_start_, at_end_;
};

}  // namespace

FusionState fuse_fixed_weight(const MarkerPath& markers, double weight, double fade_length, LanePath& lane) {
  const LanePath line = lane;
  Correction correction(line, markers, fade_length);
  const Offset offset = correction.near_vehicle();
  if (weight > 0.0) {
    for (PathPoint& point : lane.points) {
      const Point2 move = weight * correction.at(point, point.s - line.s_at_vehicle);
      point.position += move.x() * point.direction + move.y() * left_of(point.direction);
    }
    compute_arc_length(lane.points);
    compute_geometry(lane.points);
    locate_vehicle(lane);
  }
  lane.left_half_width = markers.path.left_half_width;
  lane.right_half_width = markers.path.right_half_width;

  FusionState state;
  state.source = Source::kFused;
  state.method = "fixed_weight";
  state.lateral_offset.value = weight * offset.value.y();
  state.heading_offset.value = weight * offset.heading;
  state.marker_range = std::max(0.0, markers.trusted_to - markers.path.s_at_vehicle);
  return state;
}

}  // namespace relative_map::core
