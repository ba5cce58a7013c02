#include "relative_map/pipeline/fixed_weight/lane_fusion.hpp"

#include <algorithm>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kSameLane = 2.5;       // [m] apart that line and markers of one lane may be
constexpr double kSameDirection = 0.2;  // [rad] between them
constexpr double kTrustStep = 1.0;      // [m] between the places where that is looked at
constexpr double kDirectionReach =
    2.5;  // [m] to both sides, over which a line's direction is taken: it may be noisy
constexpr double kDifferenceStep =
    5.0;  // [m] between the places that slopes are taken from, for the same reason
constexpr double kSettleLength = 20.0;  // [m] past the paint, over which the slope of the correction ends

/// The line and the marker path, looked up at the same arc length from the vehicle.
class PathPair {
 public:
  PathPair(const LanePath& line, const LanePath& markers) : line_(line), markers_(markers) {}

  Point2 on_line(double from_vehicle) {
    return interpolate(line_.points, line_.s_at_vehicle + from_vehicle, line_hint_).position;
  }
  PathPoint on_markers(double from_vehicle) {
    return interpolate_smoothly(markers_.points, markers_.s_at_vehicle + from_vehicle, markers_hint_);
  }
  /// Of the line.
  Point2 direction(double from_vehicle) {
    const Point2 chord = on_line(from_vehicle + kDirectionReach) - on_line(from_vehicle - kDirectionReach);
    const bool past_ends = chord.squaredNorm() == 0.0;
    return past_ends ? line_.points[line_hint_].direction : chord.normalized();
  }
  /// Of the markers from the line: along it and to its left [m].
  Point2 offset(double from_vehicle) {
    const Point2 gap = on_markers(from_vehicle).position - on_line(from_vehicle);
    const Point2 ahead = direction(from_vehicle);
    return {ahead.dot(gap), cross(ahead, gap)};
  }
  /// Of the markers from the line [rad].
  double heading(double from_vehicle) {
    const Point2 line = direction(from_vehicle), markers = on_markers(from_vehicle).direction;
    return std::atan2(cross(line, markers), line.dot(markers));
  }
  bool of_one_lane(double from_vehicle) {
    return offset(from_vehicle).norm() <= kSameLane && std::abs(heading(from_vehicle)) <= kSameDirection;
  }

 private:
  const LanePath& line_;
  const LanePath& markers_;
  std::size_t line_hint_ = 0;
  std::size_t markers_hint_ = 0;
};

/// How the offset goes on past an end of the stretch where paint was seen.
struct Ending {
  Point2 value;
  Point2 slope = Point2::Zero();  ///< by the distance past the end
  Point2 bend = Point2::Zero();   ///< second derivative
};

/// By differences over the last of `length` [m] on the side `inward` (1 or -1) of an end.
Ending ending_at(PathPair& pair, double end, double inward, double length) {
  Ending ending{pair.offset(end)};
  const double step = std::min(kDifferenceStep, 0.5 * length);
  if (step < 0.5 * kDifferenceStep) return ending;  // too short to tell
  const Point2 near = pair.offset(end + inward * step), far = pair.offset(end + 2.0 * inward * step);
  ending.slope = (3.0 * ending.value - 4.0 * near + far) / (2.0 * step);
  ending.bend = (ending.value - 2.0 * near + far) / (step * step);
  return ending;
}

/// From an ending to rest in 0, by quintics: the value over `length` [m], slope and bend sooner, since they
/// would else carry it far away. `distance` is past the end.
Point2 fade_out(const Ending& ending, double distance, double length) {
  const double settle_length = std::min(length, kSettleLength);
  const double t = std::min(1.0, distance / length), u = std::min(1.0, distance / settle_length);
  const double t3 = t * t * t, u2 = u * u, u3 = u2 * u;
  return ending.value * (1.0 - t3 * (10.0 - t * (15.0 - 6.0 * t))) +
         ending.slope * settle_length * (u - u3 * (6.0 - u * (8.0 - 3.0 * u))) +
         ending.bend * settle_length * settle_length * 0.5 * (u2 - u3 * (3.0 - u * (3.0 - u)));
}

/// What the line is moved by to become the marker path, at a distance [m] from the vehicle along it.
class Correction {
 public:
  Correction(const LanePath& line, const MarkerPath& markers, double fade_length)
      : pair_(line, markers.path),
        from_(markers.trusted_from - markers.path.s_at_vehicle),
        to_(markers.trusted_to - markers.path.s_at_vehicle),
        fade_length_(fade_length),
        start_(ending_at(pair_, from_, 1.0, to_ - from_)),
        end_(ending_at(pair_, to_, -1.0, to_ - from_)) {}

  Point2 at(double from_vehicle, const Point2& on_line) {
    if (from_vehicle >= from_ && from_vehicle <= to_) {
      return pair_.on_markers(from_vehicle).position - on_line;
    }
    const Point2 offset = from_vehicle < from_ ? settled(from_ - from_vehicle)
                                               : fade_out(end_, from_vehicle - to_, fade_length_);
    if (offset.isZero(0.0)) return offset;
    const Point2 ahead = pair_.direction(from_vehicle);
    return offset.x() * ahead + offset.y() * left_of(ahead);
  }
  double lateral_near_vehicle() { return pair_.offset(near_vehicle()).y(); }
  double heading_near_vehicle() { return pair_.heading(near_vehicle()); }

 private:
  /// Beside the vehicle, or at the paint that is nearest to it.
  double near_vehicle() const { return std::clamp(0.0, from_, to_); }
  Point2 settled(double before_start) const {
    const Ending slopes{Point2::Zero(), start_.slope, start_.bend};
    return start_.value + fade_out(slopes, before_start, kSettleLength);
  }

  PathPair pair_;
  double from_, to_;  ///< [m] from the vehicle: where paint was seen
  double fade_length_;
  Ending start_, end_;
};

}  // namespace

std::optional<std::string> trust_within_lane(const LanePath& lane, MarkerPath& markers) {
  PathPair pair(lane, markers.path);
  const double s_at_vehicle = markers.path.s_at_vehicle;
  const double from = markers.trusted_from - s_at_vehicle, to = markers.trusted_to - s_at_vehicle;
  const double here = std::clamp(0.0, from, to);
  if (!pair.of_one_lane(here)) {
    std::ostringstream reason;
    reason.precision(3);
    reason << "they are another lane's: line '" << lane.id << "' is " << pair.offset(here).norm()
           << " m from them, and " << std::abs(pair.heading(here)) << " rad askew";
    return reason.str();
  }
  double first = here, last = here;
  while (last < to && pair.of_one_lane(std::min(to, last + kTrustStep))) last += kTrustStep;
  while (first > from && pair.of_one_lane(std::max(from, first - kTrustStep))) first -= kTrustStep;
  markers.trusted_to = s_at_vehicle + std::min(last, to);
  markers.trusted_from = s_at_vehicle + std::max(first, from);
  return std::nullopt;
}

FusionState fuse_fixed_weight(const MarkerPath& markers, double weight, double fade_length, LanePath& lane) {
  const LanePath line = lane;
  Correction correction(line, markers, fade_length);
  if (weight > 0.0) {
    for (PathPoint& point : lane.points) {
      point.position += weight * correction.at(point.s - line.s_at_vehicle, point.position);
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
  state.lateral_offset.value = weight * correction.lateral_near_vehicle();
  state.heading_offset.value = weight * correction.heading_near_vehicle();
  state.marker_range = std::max(0.0, markers.trusted_to - markers.path.s_at_vehicle);
  return state;
}

}  // namespace relative_map::core
