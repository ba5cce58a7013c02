#include "relative_map/pipeline/map_check.hpp"

#include <algorithm>
#include <cmath>
#include <set>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kLengthTolerance = 1e-3;   // [m] a point
constexpr double kWidthTolerance = 0.01;    // [m]
constexpr double kHeadingTolerance = 0.01;  // [rad]
constexpr double kTurnWindow = 5.0;         // [m] over which curvature must add up to the turn

using Fault = std::optional<std::string>;

template <class... Parts>
Fault fault(const Parts&... parts) {
  std::ostringstream text;
  text.precision(6);
  (text << ... << parts);
  return text.str();
}

std::size_t index_of(const RelativeMap& map, const std::string& id) {
  std::size_t i = 0;
  while (i < map.lanes.size() && map.lanes[i].id != id) ++i;
  return i;
}

/// The first fault that `check` finds in any lane, with the lane's id before it.
template <class Check>
Fault first_in_lanes(const RelativeMap& map, Check check) {
  for (const Lane& lane : map.lanes) {
    if (Fault found = check(lane)) return fault("lane '", lane.id, "': ", *found);
  }
  return std::nullopt;
}

Fault check_header(const RelativeMap& map, const MapContext& context) {
  if (map.frame_id != context.frame_id)
    return fault("frame_id is '", map.frame_id, "', not '", context.frame_id, "'");
  if (map.stamp <= Time::zero()) return fault("the stamp is not set");
  if (context.previous_sequence_num && map.sequence_num != *context.previous_sequence_num + 1) {
    return fault("sequence_num is ", map.sequence_num, " after ", *context.previous_sequence_num);
  }
  return std::nullopt;
}

Fault check_emptiness(const RelativeMap& map, const MapContext&) {
  const bool ok = map.status.code == StatusCode::kOk;
  if (!map.lanes.empty()) return ok ? std::nullopt : fault("there are lanes, but the status is not OK");
  if (ok) return fault("there is no lane, but the status is OK");
  if (!map.roads.empty()) return fault("there is a road without a lane");
  if (!map.current_lane_id.empty()) return fault("there is a current lane in an empty map");
  return std::nullopt;
}

Fault check_lane_ids(const RelativeMap& map, const MapContext&) {
  std::set<std::string> ids;
  for (const Lane& lane : map.lanes) {
    if (lane.id.empty()) return fault("a lane has no id");
    if (!ids.insert(lane.id).second) return fault("two lanes are called '", lane.id, "'");
  }
  if (!map.lanes.empty() && ids.count(map.current_lane_id) == 0) {
    return fault("the current lane '", map.current_lane_id, "' does not exist");
  }
  return std::nullopt;
}

Fault check_priority(const RelativeMap& map, const MapContext&) {
  if (map.lanes.empty()) return std::nullopt;
  const auto best =
      std::count_if(map.lanes.begin(), map.lanes.end(), [](const Lane& lane) { return lane.priority == 0; });
  return best == 1 ? std::nullopt : fault(best, " paths have priority 0");
}

bool finite(double value) {
  return std::isfinite(value);
}
bool finite(const Point2& point) {
  return point.allFinite();
}
bool finite(const Estimate& estimate) {
  return finite(estimate.value) && finite(estimate.stddev);
}
bool finite(const PathPoint& point) {
  return finite(point.position) && finite(point.theta) && finite(point.kappa) && finite(point.dkappa) &&
         finite(point.s);
}
bool finite(const WidthSample& sample) {
  return finite(sample.s) && finite(sample.width);
}
bool finite(const PaintSpan& span) {
  return finite(span.s);
}
template <class T>
bool finite(const std::vector<T>& values) {
  return std::all_of(values.begin(), values.end(), [](const T& value) { return finite(value); });
}

Fault check_finite(const RelativeMap& map, const MapContext&) {
  const FusionState& fusion = map.fusion;
  if (!finite(fusion.lateral_offset) || !finite(fusion.longitudinal_offset) ||
      !finite(fusion.heading_offset) || !finite(fusion.left_half_width) || !finite(fusion.right_half_width) ||
      !finite(fusion.marker_range) || !finite(fusion.marker_age)) {
    return fault("the fusion state is not finite");
  }
  for (const Road& road : map.roads) {
    if (!finite(road.left_edge) || !finite(road.right_edge))
      return fault("an edge of the road is not finite");
  }
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (!finite(lane.path)) return fault("a point of the path is not finite");
    if (!finite(lane.length) || !finite(lane.remaining_distance) || !finite(lane.speed_limit)) {
      return fault("length, remaining distance or speed limit is not finite");
    }
    for (const LaneBoundary* boundary : {&lane.left_boundary, &lane.right_boundary}) {
      if (!finite(boundary->points) || !finite(boundary->length) || !finite(boundary->paint)) {
        return fault("a boundary is not finite");
      }
    }
    if (!finite(lane.left_samples) || !finite(lane.right_samples) || !finite(lane.left_road_samples) ||
        !finite(lane.right_road_samples)) {
      return fault("a width sample is not finite");
    }
    return std::nullopt;
  });
}

Fault check_centerline(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (lane.path.size() < 2) return fault("its centerline has ", lane.path.size(), " points");
    if (lane.left_boundary.points.size() < 2) return fault("its left boundary is no line");
    if (lane.right_boundary.points.size() < 2) return fault("its right boundary is no line");
    return std::nullopt;
  });
}

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

Fault check_samples(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (Fault found = check_side(lane, lane.left_boundary, lane.left_samples)) return fault("left: ", *found);
    if (Fault found = check_side(lane, lane.right_boundary, lane.right_samples))
      return fault("right: ", *found);
    return std::nullopt;
  });
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

Fault check_road(const RelativeMap& map, const MapContext&) {
  if (map.lanes.empty()) return std::nullopt;
  if (map.roads.size() != 1) return fault("there are ", map.roads.size(), " roads");
  const Road& road = map.roads.front();
  const bool same = std::equal(road.lane_ids.begin(), road.lane_ids.end(), map.lanes.begin(), map.lanes.end(),
                               [](const std::string& id, const Lane& lane) { return id == lane.id; });
  if (!same) return fault("the road's lanes are not the map's");
  if (road.left_edge != map.lanes.front().left_boundary.points)
    return fault("the left edge is not the outermost boundary");
  if (road.right_edge != map.lanes.back().right_boundary.points)
    return fault("the right edge is not the outermost boundary");
  return std::nullopt;
}

Fault check_attributes(const RelativeMap& map, const MapContext&) {
  return first_in_lanes(map, [](const Lane& lane) -> Fault {
    if (!(lane.speed_limit > 0.0)) return fault("speed_limit is ", lane.speed_limit);
    for (const LaneBoundary* boundary : {&lane.left_boundary, &lane.right_boundary}) {
      if (boundary->paint.empty()) return fault("a boundary has no type");
      if (boundary->paint.front().s != 0.0)
        return fault("boundary types start at ", boundary->paint.front().s, " m");
      if (std::abs(boundary->length - chord_length(boundary->points)) > kLengthTolerance) {
        return fault("a boundary's length is ", boundary->length, " m, not that of its points");
      }
    }
    return std::nullopt;
  });
}

struct Row {
  const char* name;
  Fault (*check)(const RelativeMap&, const MapContext&);
};

/// Rows that hold for any numbers.
constexpr Row kPlainRows[] = {
    {"header", check_header},     {"emptiness", check_emptiness}, {"lane_ids", check_lane_ids},
    {"priority", check_priority}, {"finite", check_finite},       {"centerline", check_centerline},
};
/// Rows that need finite numbers and paths of two or more points.
constexpr Row kGeometryRows[] = {
    {"arc_length", check_arc_length}, {"heading", check_heading},     {"curvature", check_curvature},
    {"samples", check_samples},       {"neighbors", check_neighbors}, {"road", check_road},
    {"attributes", check_attributes},
};

}  // namespace

std::vector<std::string> map_check_rows() {
  std::vector<std::string> names;
  for (const Row& row : kPlainRows) names.emplace_back(row.name);
  for (const Row& row : kGeometryRows) names.emplace_back(row.name);
  return names;
}

std::vector<Violation> check_map(const RelativeMap& map, const MapContext& context) {
  std::vector<Violation> violations;
  const auto run = [&](const auto& rows) {
    for (const Row& row : rows) {
      if (Fault found = row.check(map, context)) violations.push_back({row.name, *found});
    }
  };
  run(kPlainRows);
  if (violations.empty()) run(kGeometryRows);
  return violations;
}

}  // namespace relative_map::core
