#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kAlikeDistance = 2.0;  // [m] passes that are this much farther than the nearest still count
constexpr double kMetersPerRadian =
    5.0;                             // without a history, this much heading error weighs as much as a metre
constexpr double kContinuity = 3.0;  // [m] from the place expected, besides the way driven

}  // namespace

struct NavigationLineTracker::Pass {
  Foot foot;
  LineProjection projection;
  Point2 direction;
  bool past_end;
};

namespace {

struct Segment {
  const PathPoint& a;
  const PathPoint& b;
  double length;
};

Segment segment_of(const NavigationLine& line, std::size_t index) {
  const bool stitch = index + 1 == line.points.size();
  const PathPoint& a = line.points[index];
  const PathPoint& b = line.points[stitch ? 0 : index + 1];
  return {a, b, (stitch ? line.length : b.s) - a.s};
}

/// [rad] of the line; at a kink, where the line has no tangent, of its segment.
double heading_at(const NavigationLine& line, const Foot& foot) {
  const Segment segment = segment_of(line, foot.segment);
  if (line.is_kink(foot.segment) || line.is_kink((foot.segment + 1) % line.points.size())) {
    const Point2 along = segment.b.position - segment.a.position;
    return std::atan2(along.y(), along.x());
  }
  return interpolate_angle(segment.a.theta, segment.b.theta, foot.fraction);
}

/// The vehicle's place beside one foot. Beyond the ends of an open line s and l are those of its tangent.
LineProjection project(const NavigationLine& line, const Foot& foot, const Point2& position, double heading) {
  const Segment segment = segment_of(line, foot.segment);
  const bool before_start = !line.closed() && foot.segment == 0 && foot.fraction <= 0.0;
  const bool past_end = !line.closed() && foot.segment + 2 == line.points.size() && foot.fraction >= 1.0;
  LineProjection projection;
  projection.nearest_vertex = foot.fraction < 0.5 ? foot.segment : (foot.segment + 1) % line.points.size();
  projection.s = segment.a.s + foot.fraction * segment.length;
  projection.distance = std::sqrt(foot.squared_distance);
  const double theta = heading_at(line, foot);
  const Point2 direction(std::cos(theta), std::sin(theta));
  const Point2 offset = position - foot.point;
  const double side = cross(direction, offset);
  projection.l = std::copysign(projection.distance, side);
  if (before_start || past_end) {
    projection.s += direction.dot(offset);
    projection.l = side;
  }
  projection.heading_offset = angle_difference(heading, theta);
  projection.remaining = line.closed() ? line.length : line.length - projection.s;
  return projection;
}

LineDrop off_route(const char* what, double value, const char* unit) {
  std::ostringstream reason;
  reason.precision(3);
  reason << what << " " << value << " " << unit;
  return {StatusCode::kOffRoute, reason.str()};
}

/// [m] between two places of a line, the short way round on a lap.
double gap_between(const NavigationLine& line, double s, double expected) {
  const double gap = s - expected;
  return std::abs(line.closed() ? std::remainder(gap, line.length) : gap);
}

}  // namespace

std::optional<double> NavigationLineTracker::expected_s(const VehicleState& vehicle) const {
  if (!last_ || has_jumped(last_->vehicle, vehicle)) return std::nullopt;
  const Point2 moved = vehicle.map_from_base.position() - last_->vehicle.map_from_base.position();
  return last_->s + moved.dot(last_->direction);
}

const NavigationLineTracker::Pass& NavigationLineTracker::choose(const std::vector<Pass>& passes,
                                                                 const NavigationLine& line,
                                                                 const VehicleState& vehicle) const {
  const auto nearest = std::min_element(passes.begin(), passes.end(), [](const Pass& a, const Pass& b) {
    return a.projection.distance < b.projection.distance;
  });
  const double reach = nearest->projection.distance + kAlikeDistance;
  const auto best_by = [&](auto cost) -> const Pass& {
    const Pass* best = &*nearest;
    for (const Pass& pass : passes) {
      if (pass.projection.distance <= reach && cost(pass) < cost(*best)) best = &pass;
    }
    return *best;
  };
  if (const std::optional<double> expected = expected_s(vehicle)) {
    const Pass& next =
        best_by([&](const Pass& pass) { return gap_between(line, pass.projection.s, *expected); });
    const double driven = (vehicle.map_from_base.position() - last_->vehicle.map_from_base.position()).norm();
    if (gap_between(line, next.projection.s, *expected) < kContinuity + driven) return next;
  }
  const auto cost = [](const Pass& pass) {
    return pass.projection.distance + kMetersPerRadian * std::abs(pass.projection.heading_offset);
  };
  // Of passes that fit alike, where a town's streets are driven twice, it is the one where the vehicle last
  // was, or the first: a route is driven from its start.
  const double most = cost(best_by(cost)) + kAlikeDistance;
  return best_by([&](const Pass& pass) {
    if (cost(pass) > most) return std::numeric_limits<double>::max();
    return last_ ? gap_between(line, pass.projection.s, last_->s) : pass.projection.s;
  });
}

std::variant<LineProjection, LineDrop> NavigationLineTracker::track(const NavigationLine& line,
                                                                    const VehicleState& vehicle,
                                                                    double max_distance) {
  const Point2 position = vehicle.map_from_base.position() - line.origin;
  // Cheap, for messages with thousands of lines.
  if (const double away = line.bounds.exteriorDistance(position); away > max_distance) {
    reset();
    return off_route("it is away by more than", away, "m");
  }
  std::vector<Pass> passes;
  std::optional<double> opposed;
  for (const Foot& foot : line.index.passes(line.points, position, max_distance)) {
    const LineProjection projection = project(line, foot, position, vehicle.map_from_base.heading());
    if (std::abs(projection.heading_offset) > kPi / 2.0) {
      opposed = projection.heading_offset;
      continue;
    }
    const Segment segment = segment_of(line, foot.segment);
    passes.push_back({foot, projection, (segment.b.position - segment.a.position).normalized(),
                      !line.closed() && projection.s > line.length});
  }
  if (passes.empty()) {
    reset();
    if (opposed) return off_route("it runs the other way, by", *opposed * 180.0 / kPi, "degrees");
    const Foot nearest = line.index.nearest(line.points, position);
    return off_route("it is away by", std::sqrt(nearest.squared_distance), "m");
  }
  const Pass& pass = choose(passes, line, vehicle);
  last_ = Place{pass.projection.s, pass.direction, vehicle};
  if (pass.past_end) return LineDrop{StatusCode::kLineEnd, "the vehicle is past its end"};
  return pass.projection;
}

}  // namespace relative_map::core
