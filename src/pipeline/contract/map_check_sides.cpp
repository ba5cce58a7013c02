// Which side borders lie on, how far away, and what they share: looked at with a walk of its own, which the
// builder does not use.
#include <algorithm>
#include <cmath>

#include "map_check_rows.hpp"

namespace relative_map::core {

namespace {

constexpr double kWidthTolerance = 0.01;  // [m]
constexpr double kEndSlack =
    1.0;                        // [m] along the lane that a border may lack at either end, besides its width
constexpr double kReach = 2.0;  // [m] over which directions are taken: a line may be noisy
constexpr double kLaneWidth = 3.5;  // [m] farther apart, borders are not of the same place
constexpr double kOverlap = 0.05;   // [m] that borders of two lanes may lie in each other

/// A border's point beside another point.
struct Beside {
  std::size_t segment = 0;
  double place = 0.0;  ///< along the segment: 0 to 1, but for what lies beyond an end
  Point2 foot = Point2::Zero();
  double distance = 0.0;  ///< [m]
};

Beside beside_segment(const Polyline& border, std::size_t segment, const Point2& point) {
  const Point2 &a = border[segment], along = border[segment + 1] - a;
  Beside beside;
  beside.segment = segment;
  beside.place = along.dot(point - a) / along.squaredNorm();
  beside.foot = a + std::clamp(beside.place, 0.0, 1.0) * along;
  beside.distance = (point - beside.foot).norm();
  return beside;
}

/// Goes along a border beside points that go along it too. Where a border folds, it may lose its way: then
/// all of the border is looked at.
class March {
 public:
  explicit March(const Polyline& border) : border_(border) {}

  Beside go_to(const Point2& point) {
    while (segment_ + 2 < border_.size() && is_past(point)) ++segment_;
    return beside_segment(border_, segment_, point);
  }
  /// As far away as `width` [m]; none: nothing of the border that is beside the point is.
  std::optional<Beside> go_to(const Point2& point, double width) {
    const auto fits = [&](const Beside& beside) {
      return std::abs(beside.distance - width) <= kWidthTolerance;
    };
    const Beside first = go_to(point);
    if (fits(first)) return first;
    const std::size_t segments = border_.size() - 1;
    for (std::size_t step = 1; step < segments; ++step) {  // to both sides
      for (const bool ahead : {true, false}) {
        if (ahead ? segment_ + step >= segments : step > segment_) continue;
        const Beside other = beside_segment(border_, ahead ? segment_ + step : segment_ - step, point);
        if (!fits(other) || !is_square(other, point)) continue;
        segment_ = other.segment;
        return other;
      }
    }
    return std::nullopt;
  }
  /// Of all of the border.
  Beside nearest(const Point2& point) {
    Beside nearest = beside_segment(border_, 0, point);
    for (std::size_t i = 1; i + 1 < border_.size(); ++i) {
      const Beside other = beside_segment(border_, i, point);
      if (other.distance < nearest.distance) nearest = other;
    }
    segment_ = nearest.segment;
    return nearest;
  }
  bool beyond_end(const Beside& beside) const {
    return (beside.segment == 0 && beside.place <= 0.0) ||
           (beside.segment + 2 == border_.size() && beside.place >= 1.0);
  }
  /// Two borders may part where one of them ends.
  bool near_end(const Beside& beside) const {
    return (beside.foot - border_.front()).norm() < kEndSlack ||
           (beside.foot - border_.back()).norm() < kEndSlack;
  }
  /// [m] by which `point` lies to the left of the border's direction.
  double to_left(const Point2& point, const Beside& beside) const {
    const Point2 along = border_[beside.segment + 1] - border_[beside.segment];
    return cross(along, point - beside.foot) / along.norm();
  }

 private:
  bool is_past(const Point2& point) const {
    const Point2& end = border_[segment_ + 1];
    return (point - end).dot(end - border_[segment_]) > 0.0;
  }

  /// Whether the way to the point is square to the border, so that it gets longer to both sides.
  bool is_square(const Beside& beside, const Point2& point) const {
    if (beside.place < 0.0) return beside.segment == 0;
    if (beside.place <= 1.0 || beside.segment + 2 == border_.size()) return true;
    return beside_segment(border_, beside.segment + 1, point).place < 0.0;
  }

  const Polyline& border_;
  std::size_t segment_ = 0;
};

struct Border {
  const Polyline& points;
  const std::vector<WidthSample>& samples;
  double sign;  ///< 1: to the left; -1: to the right
};

Point2 position_at(const PathPoints& path, double s, std::size_t& hint) {
  while (hint + 1 < path.size() && path[hint + 1].s <= s) ++hint;
  return path[hint].s == s ? path[hint].position : interpolate(path, s, hint).position;
}

/// From an end of a path into it.
Point2 direction_at_end(const PathPoints& path, bool at_start) {
  const std::size_t n = path.size();
  std::size_t i = 1;
  const auto at = [&](std::size_t k) -> const PathPoint& { return path[at_start ? k : n - 1 - k]; };
  while (i + 1 < n && std::abs(at(i).s - at(0).s) < kReach) ++i;
  return (at(i).position - at(0).position).normalized();
}

/// Of a path over a stretch to both sides of a vertex.
Point2 direction_near(const PathPoints& path, std::size_t i) {
  std::size_t from = i, to = i;
  while (from > 0 && path[i].s - path[from].s < kReach) --from;
  while (to + 1 < path.size() && path[to].s - path[i].s < kReach) ++to;
  return path[to].position - path[from].position;
}

Fault check_ends(const Lane& lane, const Border& border, double& s) {
  for (const bool at_start : {true, false}) {
    const Point2& end = at_start ? lane.path.front().position : lane.path.back().position;
    const Point2& border_end = at_start ? border.points.front() : border.points.back();
    const double width = at_start ? border.samples.front().width : border.samples.back().width;
    const double lacking = direction_at_end(lane.path, at_start).dot(border_end - end);
    if (lacking > kEndSlack + width) {
      s = at_start ? 0.0 : lane.length - lacking;
      return at_start ? fault("it starts ", lacking, " m after the lane")
                      : fault("it ends ", lacking, " m before the lane");
    }
  }
  return std::nullopt;
}

bool is_on_side(const PathPoints& path, std::size_t i, const Point2& to_side) {
  const Point2 along = path[std::min(i + 1, path.size() - 1)].position - path[i == 0 ? 0 : i - 1].position;
  // A noisy line has its direction over some metres, a bend here.
  return cross(along, to_side) > 0.0 || cross(direction_near(path, i), to_side) > 0.0;
}

/// One walk along a border, at its samples.
BorderFaults check_border(const Lane& lane, const Border& border, double most) {
  BorderFaults found;
  if (border.samples.empty()) {
    found.samples = fault("there are no samples");
    return found;
  }
  if (border.samples.front().s != 0.0)
    found.samples = fault("samples start at ", border.samples.front().s, " m");
  else if (std::abs(border.samples.back().s - lane.length) > kLengthTolerance)
    found.samples = fault("samples end at ", border.samples.back().s, " m of ", lane.length, " m");
  found.sides = check_ends(lane, border, found.s);
  March march(border.points);
  std::size_t hint = 0;
  double previous = -1.0;
  for (const WidthSample& sample : border.samples) {
    const bool right_so_far = !found.samples && !found.sides;
    const Point2 position = position_at(lane.path, sample.s, hint);
    const std::optional<Beside> beside = march.go_to(position, sample.width);
    if (!found.samples) {
      if (sample.s <= previous) {
        found.samples = fault("samples step back at ", sample.s, " m");
      } else if (!(sample.width > 0.0)) {
        found.samples = fault("width is ", sample.width, " m at ", sample.s, " m");
      } else if (!beside) {
        found.samples = fault("width is ", sample.width, " m at ", sample.s, " m, but the boundary is ",
                              march.nearest(position).distance, " m away");
      }
    }
    if (!found.sides && sample.width > most)
      found.sides = fault("no lane is ", sample.width, " m wide from its center, as at s = ", sample.s, " m");
    if (!found.sides && beside && !march.beyond_end(*beside) &&
        !is_on_side(lane.path, hint, border.sign * (beside->foot - position)))
      found.sides = fault("it lies on the other side at s = ", sample.s, " m, by ", beside->distance, " m");
    if (right_so_far) found.s = sample.s;
    if (found.samples && found.sides) break;
    previous = sample.s;
  }
  return found;
}

/// The border of the lane to the right does not lie farther left than this lane's own.
Fault check_overlap(const Lane& left, const Lane& right) {
  March march(left.right_boundary.points);
  for (const Point2& point : right.left_boundary.points) {
    const auto overlap = [&](const Beside& beside) {
      return march.near_end(beside) ? 0.0 : march.to_left(point, beside);
    };
    if (!(overlap(march.go_to(point)) > kOverlap)) continue;
    const double by = overlap(march.nearest(point));
    // Farther away, it is another part of the other lane.
    if (by > kOverlap && by < kLaneWidth)
      return fault("'", right.id, "' lies ", by, " m in '", left.id, "' at x = ", point.x());
  }
  return std::nullopt;
}

/// Two borders of neighbours are one where both exist.
Fault check_shared_boundary(const Lane& left, const Lane& right) {
  March march(right.left_boundary.points);
  for (const Point2& point : left.right_boundary.points) {
    const Beside beside = march.go_to(point);
    if (beside.distance <= kWidthTolerance || march.beyond_end(beside)) continue;
    const Beside nearest = march.nearest(point);
    // Farther away, it is another part of the other lane.
    if (nearest.distance <= kWidthTolerance || nearest.distance > kLaneWidth) continue;
    if (march.near_end(nearest)) continue;
    return fault("lanes '", left.id, "' and '", right.id, "' have boundaries ", nearest.distance,
                 " m apart at x = ", point.x());
  }
  return std::nullopt;
}

std::size_t index_of(const RelativeMap& map, const std::string& id) {
  std::size_t i = 0;
  while (i < map.lanes.size() && map.lanes[i].id != id) ++i;
  return i;
}

}  // namespace

BorderFaults check_borders(const RelativeMap& map, const MapContext& context) {
  BorderFaults found;
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    const Lane& lane = map.lanes[i];
    const auto take = [&](const char* side, const BorderFaults& border) {
      const bool first = !found.samples && !found.sides;
      const auto in_lane = [&](const Fault& what) {
        return fault("lane '", lane.id, "': ", side, ": ", *what);
      };
      if (border.samples && !found.samples) found.samples = in_lane(border.samples);
      if (border.sides && !found.sides) found.sides = in_lane(border.sides);
      if (!first || (!border.samples && !border.sides)) return;
      found.lane = i;
      found.s = border.s;
    };
    take("left",
         check_border(lane, {lane.left_boundary.points, lane.left_samples, 1.0}, context.max_half_width));
    take("right",
         check_border(lane, {lane.right_boundary.points, lane.right_samples, -1.0}, context.max_half_width));
  }
  for (std::size_t i = 0; !found.sides && !found.samples && i + 1 < map.lanes.size(); ++i) {
    const bool neighbors = map.lanes[i].right_neighbor_id == map.lanes[i + 1].id;  // they share the border
    if (!neighbors) found.sides = check_overlap(map.lanes[i], map.lanes[i + 1]);
    const bool left_is_better =
        map.lanes[i].id == map.current_lane_id ||
        (map.lanes[i + 1].id != map.current_lane_id && map.lanes[i].priority <= map.lanes[i + 1].priority);
    found.lane = left_is_better ? i + 1 : i;  // the one to be left out
  }
  return found;
}

std::optional<BadLane> find_bad_lane(const RelativeMap& map, const MapContext& context) {
  const BorderFaults found = check_borders(map, context);
  if (!found.samples && !found.sides) return std::nullopt;
  return BadLane{found.lane, found.s, found.sides ? *found.sides : *found.samples};
}

Fault check_neighbors(const RelativeMap& map, const MapContext&) {
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    const Lane& lane = map.lanes[i];
    for (const bool to_left : {true, false}) {
      const std::string& id = to_left ? lane.left_neighbor_id : lane.right_neighbor_id;
      if (id.empty()) continue;
      const std::size_t other = index_of(map, id);
      if (other == map.lanes.size())
        return fault("lane '", lane.id, "' has a neighbour '", id, "' that is not there");
      if (to_left ? other >= i : other <= i)
        return fault("lane '", id, "' is on the wrong side of '", lane.id, "'");
      const std::string& back =
          to_left ? map.lanes[other].right_neighbor_id : map.lanes[other].left_neighbor_id;
      if (back != lane.id) return fault("lane '", id, "' does not know its neighbour '", lane.id, "'");
      if (to_left) continue;
      if (Fault found = check_shared_boundary(lane, map.lanes[other])) return found;
    }
  }
  return std::nullopt;
}

}  // namespace relative_map::core
