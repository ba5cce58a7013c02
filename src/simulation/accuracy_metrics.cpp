#include "relative_map/simulation/accuracy_metrics.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
namespace relative_map::core {

namespace {

constexpr double kPastEnd = 1.0;         // [m] beyond a line's end that it is taken to go straight on
constexpr double kReach = 90.0;          // [m] of a lane that is looked at
constexpr double kUsableError = 1.5;     // [m]
constexpr double kUsableLength = 30.0;   // [m]
constexpr std::size_t kAt10 = 2;         // of kErrorDistances
constexpr double kAwayPaint = 0.3;       // [m] paint that has left its lane is none of its boundaries
constexpr double kDirectionReach = 1.0;  // [m] to both sides, over which a direction is taken

double capped(double error) {
  return std::clamp(error, -kMaxError, kMaxError);
}

struct NearestFoot {
  Foot foot;
  double past_end = 0.0;  ///< [m]
};

NearestFoot nearest_foot(const Polyline& polyline, const Point2& point) {
  NearestFoot nearest;
  nearest.foot.squared_distance = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    Foot foot = project_on_segment(polyline[i], polyline[i + 1], point);
    if (foot.squared_distance >= nearest.foot.squared_distance) continue;
    foot.segment = i;
    nearest.foot = foot;
  }
  const std::size_t i = nearest.foot.segment;
  const Point2 along = (polyline[i + 1] - polyline[i]).normalized();
  const bool at_end =
      (i == 0 && nearest.foot.fraction <= 0.0) || (i + 2 == polyline.size() && nearest.foot.fraction >= 1.0);
  if (at_end) {
    const double past = along.dot(point - nearest.foot.point);
    nearest.past_end = std::abs(past);
    nearest.foot.point += past * along;
  }
  return nearest;
}

const Lane* current_lane(const RelativeMap& map) {
  const auto found = std::find_if(map.lanes.begin(), map.lanes.end(),
                                  [&](const Lane& lane) { return lane.id == map.current_lane_id; });
  return found == map.lanes.end() ? nullptr : &*found;
}

/// As much of a centerline as is compared.
Polyline near_part(const Lane& lane) {
  const double end = lane.path.front().position.norm() + kReach;
  Polyline points;
  for (const PathPoint& point : lane.path) {
    points.push_back(point.position);
    if (point.s > end) break;
  }
  return points;
}

double width_at(const std::vector<WidthSample>& samples, double s) {
  const auto after =
      std::find_if(samples.begin(), samples.end(), [s](const WidthSample& sample) { return sample.s >= s; });
  if (after == samples.begin()) return samples.front().width;
  if (after == samples.end()) return samples.back().width;
  const WidthSample &a = *(after - 1), &b = *after;
  return a.width + (s - a.s) / (b.s - a.s) * (b.width - a.width);
}

}  // namespace

std::optional<double> lateral_offset(const Polyline& polyline, const Point2& point, const Point2& direction) {
  if (polyline.size() < 2) return std::nullopt;
  const NearestFoot nearest = nearest_foot(polyline, point);
  if (nearest.past_end > kPastEnd) return std::nullopt;
  const Point2 offset = nearest.foot.point - point;
  return std::copysign(offset.norm(), cross(direction, offset));
}

MapErrors AccuracyMeter::measure_lane(const Lane* lane, std::size_t true_lane, const TruePose& truth) const {
  const TrueRoad& road = drive_.road;
  const TrueLane& target = road.lanes[true_lane];
  const std::vector<RoadPlace> places =
      road.ahead(target, truth.s, {kErrorDistances.begin(), kErrorDistances.end()});
  const Pose2& base = truth.path_from_base;
  const Polyline center = lane == nullptr ? Polyline() : near_part(*lane);
  MapErrors errors;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto offset =
        lateral_offset(center, base.to_local(places[i].position), base.rotate_to_local(places[i].direction));
    if (i == 0) errors.beside = offset;
    errors.center[i] = capped(offset.value_or(kMaxError));
  }
  if (places.empty()) return errors;

  const double error = std::abs(*errors.center[std::min(kAt10, places.size() - 1)]);
  bool covers = false;
  if (lane != nullptr) {
    const NearestFoot beside = nearest_foot(center, Point2::Zero());
    const double ahead = lane->length - lane->path[beside.foot.segment].s;
    covers = ahead >= kUsableLength || ahead >= lane->remaining_distance - 1.0;
  }
  errors.usable = covers && error < kUsableError;
  if (lane == nullptr || error >= kMaxError || places.size() <= kAt10) return errors;

  const RoadPlace& place = places[kAt10];
  const Point2 here = base.to_local(place.position), direction = base.rotate_to_local(place.direction);
  const NearestFoot nearest = nearest_foot(center, here);
  const double s =
      lane->path[nearest.foot.segment].s +
      nearest.foot.fraction * (center[nearest.foot.segment + 1] - center[nearest.foot.segment]).norm();
  std::size_t hint = nearest.foot.segment;
  const Point2 chord = interpolate(lane->path, s + kDirectionReach, hint).position -
                       interpolate(lane->path, s - kDirectionReach, hint).position;
  errors.heading = std::atan2(cross(direction, chord), direction.dot(chord));

  const auto boundary = [&](std::size_t paint, const LaneBoundary& published,
                            const std::vector<WidthSample>& samples, std::optional<double>& border_error,
                            std::optional<double>& width_error) {
    const double l = road.paint[paint].l_at(road.path.hold(place.s));
    const double half_width = std::abs(l - road.center_at(target, place.s));
    if (std::abs(half_width - road.half_width_at(target, place.s)) > kAwayPaint) return;
    const RoadPlace painted = road.at(place.s, l);
    const auto offset = lateral_offset(published.points, base.to_local(painted.position), direction);
    border_error = capped(offset.value_or(kMaxError));
    width_error = capped(width_at(samples, s) - half_width);
  };
  boundary(target.left_paint, lane->left_boundary, lane->left_samples, errors.left_boundary,
           errors.left_half_width);
  boundary(target.right_paint, lane->right_boundary, lane->right_samples, errors.right_boundary,
           errors.right_half_width);
  return errors;
}

void AccuracyMeter::measure_jitter(const Published& now, const TruePose& truth, MapErrors& errors) const {
  if (!last_ || last_->true_lane != now.true_lane) return;
  const std::vector<RoadPlace> places =
      drive_.road.ahead(drive_.road.lanes[now.true_lane], truth.s, {10.0, 30.0});
  const Polyline center = near_part(now.lane), center_before = near_part(last_->lane);
  for (std::size_t i = 0; i < places.size(); ++i) {
    const auto offset_in = [&](const Polyline& polyline, const Pose2& base) {
      return lateral_offset(polyline, base.to_local(places[i].position),
                            base.rotate_to_local(places[i].direction));
    };
    const auto offset = offset_in(center, now.path_from_base),
               before = offset_in(center_before, last_->path_from_base);
    if (offset && before) (i == 0 ? errors.jitter_10 : errors.jitter_30) = capped(*offset) - capped(*before);
  }
}

MapErrors AccuracyMeter::measure(const RelativeMap& map) {
  const TruePose truth = drive_.truth_at(map.stamp);
  const Lane* lane = current_lane(map);
  std::optional<MapErrors> best;
  std::size_t true_lane = 0;
  for (const std::size_t candidate : drive_.road.lanes_at(truth.l)) {
    const MapErrors errors = measure_lane(lane, candidate, truth);
    const auto size = [](const MapErrors& e) { return std::abs(e.center[kAt10].value_or(0.0)); };
    if (best && size(errors) >= size(*best)) continue;
    best = errors;
    true_lane = candidate;
  }
  if (lane == nullptr) {
    last_.reset();
    return *best;
  }
  const double claimed = map.fusion.lateral_offset.stddev;
  if (claimed > 0.0 && best->beside) best->consistent = std::abs(*best->beside) <= 3.0 * claimed;
  Published published{*lane, truth.path_from_base, true_lane};
  measure_jitter(published, truth, *best);
  last_ = std::move(published);
  return *best;
}

}  // namespace relative_map::core
