#include <cmath>

#include "map_check_rows.hpp"

namespace relative_map::core {

namespace {

constexpr double kWidthTolerance = 0.01;    // [m]
constexpr double kHeadingTolerance = 0.01;  // [rad]
constexpr double kTurnWindow = 5.0;         // [m] over which curvature must add up to the turn

std::size_t index_of(const RelativeMap& map, const std::string& id) {
  std::size_t i = 0;
  while (i < map.lanes.size() && map.lanes[i].id != id) ++i;
  return i;
}

/// Heading at point i of the circle through it and its neighbours; at the ends the chord's, half a turn back.
Point2 chord_direction(const PathPoints& path, std::size_t i) {
  if (i > 0 && i + 1 < path.size()) {
    const Point2 before = path[i].position - path[i - 1].position;
    const Point2 after = path[i + 1].position - path[i].position;
    return before * after.squaredNorm() + after * before.squaredNorm();
  }
  const std::size_t first = i == 0 ? 0 : i - 1;
  const Point2 chord = path[first + 1].position - path[first].position;
  const double half_turn = (i == 0 ? -0.5 : 0.5) * path[i].kappa * chord.norm();
  return Pose2(Point2::Zero(), half_turn).rotate_to_parent(chord);
}

Fault check_side(const Lane& lane, const LaneBoundary& boundary, const std::vector<WidthSample>& samples) {
  if (samples.empty()) return fault("there are no samples");
  if (samples.front().s != 0.0) return fault("samples start at ", samples.front().s, " m");
  if (std::abs(samples.back().s - lane.length) > kLengthTolerance) {
    return fault("samples end at ", samples.back().s, " m of ", lane.length, " m");
  }
  PolylineWalker walker(boundary.points);
  std::size_t hint = 0;
  double previous = -1.0;
  for (const WidthSample& sample : samples) {
    if (sample.s <= previous) return fault("samples step back at ", sample.s, " m");
    if (!(sample.width > 0.0)) return fault("width is ", sample.width, " m at ", sample.s, " m");
    while (hint + 1 < lane.path.size() && lane.path[hint + 1].s <= sample.s) ++hint;
    const bool at_vertex = lane.path[hint].s == sample.s;
    const Point2 position =
        at_vertex ? lane.path[hint].position : interpolate(lane.path, sample.s, hint).position;
    const double distance = std::sqrt(walker.next(position).squared_distance);
    if (std::abs(distance - sample.width) > kWidthTolerance) {
      return fault("width is ", sample.width, " m at ", sample.s, " m, but the boundary is ", distance,
                   " m away");
    }
    previous = sample.s;
  }
  return std::nullopt;
}

/// How far two borders of neighbours lie apart where both exist.
Fault check_shared_boundary(const Lane& left, const Lane& right) {
  PolylineWalker walker(right.left_boundary.points);
  for (const Point2& point : left.right_boundary.points) {
    const Foot foot = walker.next(point);
    const double gap = std::sqrt(foot.squared_distance);
    if (!walker.beyond_end(foot) && gap > kWidthTolerance) {
      return fault("lanes '", left.id, "' and '", right.id, "' have boundaries ", gap,
                   " m apart at x = ", point.x());
    }
  }
  return std::nullopt;
}

}  // namespace

Fault check_arc_length(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (lane.path.front().s != 0.0) return fault("s starts at ", lane.path.front().s);
    for (std::size_t i = 1; i < lane.path.size(); ++i) {
      const double ds = lane.path[i].s - lane.path[i - 1].s;
      const double chord = (lane.path[i].position - lane.path[i - 1].position).norm();
      if (!(ds > 0.0)) return fault("s steps by ", ds, " m at point ", i);
      if (std::abs(ds - chord) > kLengthTolerance) {
        return fault("s steps by ", ds, " m at point ", i, ", but the chord is ", chord, " m");
      }
    }
    if (lane.length != lane.path.back().s) {
      return fault("length is ", lane.length, " m, but s ends at ", lane.path.back().s, " m");
    }
    return std::nullopt;
  });
}

Fault check_heading(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    for (std::size_t i = 0; i < lane.path.size(); ++i) {
      const double theta = lane.path[i].theta;
      const Point2 tangent = chord_direction(lane.path, i);
      const Point2 direction(std::cos(theta), std::sin(theta));
      const double error = std::atan2(cross(tangent, direction), tangent.dot(direction));
      if (std::abs(error) > kHeadingTolerance) {
        return fault("theta is off the path by ", error, " rad at s = ", lane.path[i].s, " m");
      }
    }
    return std::nullopt;
  });
}

Fault check_curvature(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    double turn = 0.0, curved = 0.0, bent = 0.0, start = 0.0;
    for (std::size_t i = 1; i < lane.path.size(); ++i) {
      const PathPoint &a = lane.path[i - 1], &b = lane.path[i];
      const double step = angle_difference(b.theta, a.theta);
      turn += step;
      bent += std::abs(step);
      curved += 0.5 * (a.kappa + b.kappa) * (b.s - a.s);
      if (b.s - start < kTurnWindow && i + 1 < lane.path.size()) continue;
      if (std::abs(turn - curved) > kHeadingTolerance + 0.3 * bent) {
        return fault("kappa adds up to ", curved, " rad before s = ", b.s, " m, but the path turns by ",
                     turn);
      }
      turn = curved = bent = 0.0;
      start = b.s;
    }
    return std::nullopt;
  });
}

Fault check_samples(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (Fault found = check_side(lane, lane.left_boundary, lane.left_samples)) return fault("left: ", *found);
    if (Fault found = check_side(lane, lane.right_boundary, lane.right_samples))
      return fault("right: ", *found);
    return std::nullopt;
  });
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
