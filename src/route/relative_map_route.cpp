#include "relative_map/route/relative_map_route.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "relative_map/route/lane_projection.hpp"

namespace relative_map::core {

namespace {

constexpr double kNearLane = 10.0;  // [m] from the vehicle a lane may be its own
constexpr double kRightAngle = kPi / 2;
constexpr double kLineEnd = 1.0;  // [m] a lane ends with its line if no more of it is left

LaneLine line_of(const Lane& lane) {
  Polyline points;
  for (const PathPoint& point : lane.path) points.push_back(point.position);
  return LaneLine(points);
}

std::optional<std::size_t> find(const RelativeMap& map, const std::string& id) {
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    if (!id.empty() && map.lanes[i].id == id) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> nearest_lane(const RelativeMap& map) {
  std::optional<std::size_t> best;
  double best_distance = kNearLane;
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    const LaneProjection origin = line_of(map.lanes[i]).project(Point2::Zero());
    if (origin.distance > best_distance || std::abs(origin.heading) > kRightAngle) continue;
    best = i;
    best_distance = origin.distance;
  }
  return best;
}

/// How many lanes to the right of the own one each lane lies, where lane changes lead to it.
std::vector<std::optional<int>> count_from(const RelativeMap& map, std::size_t own) {
  std::vector<std::optional<int>> places(map.lanes.size());
  places[own] = 0;
  for (const int side : {-1, 1}) {
    std::size_t at = own;
    for (int place = side;; place += side) {
      const Lane& lane = map.lanes[at];
      const auto next = find(map, side < 0 ? lane.left_neighbor_id : lane.right_neighbor_id);
      if (!next || places[*next]) break;
      places[*next] = place;
      at = *next;
    }
  }
  return places;
}

ChangeLane towards(int from, int to) {
  if (from == to) return ChangeLane::kForward;
  return from < to ? ChangeLane::kRight : ChangeLane::kLeft;
}

bool is_lane(const Lane& lane) {
  return lane.path.size() >= 2 &&
         std::all_of(lane.path.begin(), lane.path.end(),
                     [](const PathPoint& point) { return point.position.allFinite(); }) &&
         std::any_of(lane.path.begin(), lane.path.end(), [&](const PathPoint& point) {
           return (point.position - lane.path.front().position).norm() > 1e-3;
         });
}

RelativeMapRoute refused(RouteCode code, const std::string& why) {
  RelativeMapRoute route;
  route.update.status = {code, why};
  return route;
}

}  // namespace

RelativeMapRoute route_on_relative_map(const RelativeMap& map) {
  if (map.lanes.empty()) {
    return refused(RouteCode::kNoMap, "the relative map has no lane" +
                                          (map.status.message.empty() ? "" : ": " + map.status.message));
  }
  for (const Lane& lane : map.lanes) {
    if (!is_lane(lane))
      return refused(RouteCode::kNoMap, "lane '" + lane.id + "' of the relative map is no line");
  }
  const auto named = find(map, map.current_lane_id);
  const auto own = named ? named : nearest_lane(map);
  if (!own) return refused(RouteCode::kOffRoute, "no lane of the relative map within 10 m of the vehicle");

  const std::vector<std::optional<int>> places = count_from(map, *own);
  std::size_t target = *own;
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    if (places[i] && map.lanes[i].priority < map.lanes[target].priority) target = i;
  }
  const int target_place = *places[target];
  const double own_l = line_of(map.lanes[*own]).project(Point2::Zero()).l;

  RelativeMapRoute route;
  route.current_lane = map.lanes[*own].id;
  route.target_lane = map.lanes[target].id;
  for (std::size_t i = 0; i < map.lanes.size(); ++i) {
    const Lane& lane = map.lanes[i];
    const LaneLine line = line_of(lane);
    const LaneProjection origin = line.project(Point2::Zero());
    RouteSegments segments;
    segments.id = lane.id;
    segments.segments.push_back({lane.id, 0.0, line.length()});
    segments.s = origin.s;
    const bool ends = lane.remaining_distance <= line.length() - origin.s + kLineEnd;
    if (ends) segments.route_end = LanePosition{lane.id, line.length()};
    segments.stop_for_destination = ends && i == target;
    if (places[i]) {
      const int place = *places[i];
      segments.is_on_segment = place == 0;
      segments.is_neighbor = place != 0 && place == std::clamp(target_place, -1, 1);
      segments.next_action = towards(place, target_place);
      segments.previous_action = towards(0, place);
      segments.can_exit = place == target_place;
      segments.priority = static_cast<std::uint32_t>(std::abs(place));
    } else {
      segments.previous_action = origin.l > own_l ? ChangeLane::kRight : ChangeLane::kLeft;
      segments.priority = static_cast<std::uint32_t>(map.lanes.size());
    }
    if (i == *own) {
      RoutePlace place;
      place.lane_id = lane.id;
      place.s = origin.s;
      place.l = origin.l;
      place.distance_to_destination = map.lanes[target].remaining_distance;
      route.update.place = place;
    }
    route.update.segments.push_back(segments);
  }
  std::stable_sort(route.update.segments.begin(), route.update.segments.end(),
                   [](const RouteSegments& a, const RouteSegments& b) { return a.priority < b.priority; });
  return route;
}

}  // namespace relative_map::core
