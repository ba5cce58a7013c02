#include "relative_map/pipeline/contract/map_check.hpp"

#include <algorithm>
#include <cmath>
#include <set>

#include "map_check_rows.hpp"

namespace relative_map::core {

namespace {

Fault check_header(const RelativeMap& map, const MapContext& context) {
  if (map.frame_id != context.frame_id)
    return fault("frame_id is '", map.frame_id, "', not '", context.frame_id, "'");
  if (map.stamp <= Time()) return fault("the stamp is not set");
  if (context.previous_stamp && map.stamp < *context.previous_stamp) {
    return fault("the stamp goes back by ", to_seconds(*context.previous_stamp - map.stamp), " s");
  }
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
    {"arc_length", check_arc_length},         {"heading", check_heading},     {"curvature", check_curvature},
    {"curvature_rate", check_curvature_rate}, {"neighbors", check_neighbors}, {"road", check_road},
    {"attributes", check_attributes},
};

constexpr double kWidestLane = 6.0;  // [m] half of it, as paint may show it

}  // namespace

MapContext MapContext::of(const PipelineConfig& config) {
  MapContext context;
  context.frame_id = config.base_frame;
  context.max_half_width = std::max(
      {kWidestLane, config.map_param.default_left_width, config.map_param.default_right_width,
       2.0 * config.navigation_lane.max_lane_half_width});  // of two neighbours one may have nearly all
  return context;
}

std::vector<std::string> map_check_rows() {
  std::vector<std::string> names;
  for (const Row& row : kPlainRows) names.emplace_back(row.name);
  for (const Row& row : kGeometryRows) names.emplace_back(row.name);
  names.insert(names.end(), {"samples", "sides"});
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
  if (!violations.empty()) return violations;
  run(kGeometryRows);
  if (context.borders_are_checked) return violations;
  const BorderFaults borders = check_borders(map, context);
  if (borders.samples) violations.push_back({"samples", *borders.samples});
  if (borders.sides) violations.push_back({"sides", *borders.sides});
  return violations;
}

RelativeMap checked(RelativeMap map, const MapContext& context) {
  const std::vector<Violation> violations = check_map(map, context);
  if (violations.empty()) return map;
  RelativeMap empty;
  empty.stamp = map.stamp;
  empty.frame_id = map.frame_id;
  empty.sequence_num = map.sequence_num;
  empty.status.code = StatusCode::kContractViolation;
  for (const Violation& violation : violations) {
    empty.status.message +=
        (empty.status.message.empty() ? "" : "; ") + violation.row + ": " + violation.what;
  }
  return empty;
}

}  // namespace relative_map::core
