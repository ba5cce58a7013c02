#include "relative_map/route/lane_change_plan.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "relative_map/route/route_line.hpp"

namespace relative_map::core {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

template <class... Parts>
LaneChangePlan refused(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  LaneChangePlan plan;
  plan.why_not = text.str();
  return plan;
}

bool uncrossable(BoundaryType type, bool force) {
  if (type == BoundaryType::kCurb) return true;
  const bool solid = type == BoundaryType::kSolidWhite || type == BoundaryType::kSolidYellow ||
                     type == BoundaryType::kDoubleYellow;
  return solid && !force;
}

/// [m] from s on that paint may be crossed. What is not known may be.
double free_paint(const std::vector<PaintSpan>& paint, double s, bool force) {
  double free = kInfinity;
  for (std::size_t i = 0; i < paint.size(); ++i) {
    const double end = i + 1 < paint.size() ? paint[i + 1].s : kInfinity;
    if (end > s && uncrossable(paint[i].type, force)) free = std::min(free, std::max(0.0, paint[i].s - s));
  }
  return free;
}

const char* name_of_side(ChangeLane side) {
  return side == ChangeLane::kLeft ? "left" : "right";
}

/// The lanes ahead on both sides of the paint that is crossed.
struct Strip {
  std::vector<LanePiece> own, target;  ///< as far as they lie beside each other
  double length = 0.0;                 ///< [m] of own
  bool ends_at_paint = false;
};

/// The successor of a lane that lies beside another, on the side.
std::optional<std::size_t> follows_beside(const LaneNetwork& network, std::size_t target, std::size_t own,
                                          ChangeLane side) {
  const std::vector<std::size_t>& beside =
      side == ChangeLane::kLeft ? network.lane(own).left : network.lane(own).right;
  for (const std::size_t next : network.lane(target).successors) {
    if (std::find(beside.begin(), beside.end(), next) != beside.end()) return next;
  }
  return std::nullopt;
}

/// From a place on, until `enough` [m] are there, or the lanes part, or paint that must not be crossed
/// begins.
Strip strip_beside(const RouteIndex& index, std::size_t piece, double s, std::size_t target, ChangeLane side,
                   bool force, double enough) {
  const LaneNetwork& network = index.network();
  Strip strip;
  std::size_t own = index.pieces()[piece].lane;
  double target_s = network.lane(target).line.project(network.lane(own).line.point_at(s)).s;
  std::optional<std::size_t> at = piece;
  for (;;) {
    const LaneNetwork::Lane &lane = network.lane(own), &other = network.lane(target);
    const auto& paint = side == ChangeLane::kLeft ? lane.source.left_paint : lane.source.right_paint;
    const double left = lane.length() - s, free = free_paint(paint, s, force);
    strip.own.push_back({own, s, lane.length()});
    strip.target.push_back({target, std::clamp(target_s, 0.0, other.length()), other.length()});
    strip.length += std::min(left, free);
    strip.ends_at_paint = free < left;
    if (strip.ends_at_paint || strip.length >= enough) return strip;
    if (at) at = index.next(*at);
    std::optional<std::size_t> next;
    if (at) next = index.pieces()[*at].lane;
    if (!next && !lane.successors.empty()) next = lane.successors.front();
    const bool linked = next && std::count(lane.successors.begin(), lane.successors.end(), *next) > 0;
    const auto next_target = linked ? follows_beside(network, target, *next, side) : std::nullopt;
    if (!next_target) return strip;
    own = *next;
    target = *next_target;
    s = target_s = 0.0;
  }
}

/// Where along the target the change must be done.
LanePosition place_along(const Strip& strip, const LaneNetwork& network, double distance, std::size_t& step) {
  for (step = 0; step + 1 < strip.own.size(); ++step) {
    const double length = strip.own[step].end - strip.own[step].start;
    if (distance <= length) break;
    distance -= length;
  }
  const LanePiece &own = strip.own[step], &target = strip.target[step];
  const double share = std::min(1.0, distance / std::max(1e-9, own.end - own.start));
  return {network.lane(target.lane).source.id, target.start + share * (target.end - target.start)};
}

/// The way over the strip, and then along a route that begins on the last of its target lanes.
Route joined(const LaneNetwork& network, const Strip& strip, std::size_t last, ChangeLane side,
             const RoutePlace& place, Route on) {
  Passage own;
  own.change_lane = side;
  for (std::size_t i = 0; i <= last; ++i) {
    own.segments.push_back({network.lane(strip.own[i].lane).source.id, 0.0, strip.own[i].end});
  }
  std::vector<LaneSegment>& target = on.roads.front().passages.front().segments;
  target.front().start_s = 0.0;
  for (std::size_t i = last; i > 0; --i) {
    const LaneNetwork::Lane& lane = network.lane(strip.target[i - 1].lane);
    target.insert(target.begin(), {lane.source.id, 0.0, lane.length()});
  }
  on.roads.front().passages.insert(on.roads.front().passages.begin(), own);
  const Point2 here = network.lane(strip.own.front().lane).line.point_at(strip.own.front().start);
  on.waypoints.insert(on.waypoints.begin(), {place.lane_id, strip.own.front().start, here});
  return on;
}

}  // namespace

LaneChangePlan plan_lane_change(const RouteMap& map, RouteSearch& search, const RoutePlace& place,
                                double speed, const LaneChangeParam& param,
                                const LaneChangeRequest& request) {
  const RouteIndex& index = *map.index();
  const LaneNetwork& network = index.network();
  const std::size_t own = *network.find(place.lane_id);
  const LaneNetwork::Lane& lane = network.lane(own);
  ChangeLane side = request.to == LaneChangeGoal::kRight ? ChangeLane::kRight : ChangeLane::kLeft;
  std::optional<std::size_t> target;
  if (request.to == LaneChangeGoal::kLane) {
    const auto named = network.find(request.lane_id);
    if (!named) return refused("lane '", request.lane_id, "' is not in the lane graph");
    for (const ChangeLane candidate : {ChangeLane::kLeft, ChangeLane::kRight}) {
      const auto& beside = candidate == ChangeLane::kLeft ? lane.left : lane.right;
      if (std::count(beside.begin(), beside.end(), *named) == 0) continue;
      target = named;
      side = candidate;
    }
    if (!target)
      return refused("lane '", request.lane_id, "' does not lie beside lane '", place.lane_id,
                     "', which the vehicle is on");
  } else {
    const auto& beside = side == ChangeLane::kLeft ? lane.left : lane.right;
    if (beside.empty())
      return refused("there is no lane to the ", name_of_side(side), " of lane '", place.lane_id, "'");
    target = beside.front();
  }
  // The route's own piece that the vehicle is on.
  std::size_t piece = 0;
  while (index.pieces()[piece].segment != place.segment) ++piece;
  const double s = std::clamp(place.s, 0.0, lane.length());
  const double needed = param.needed(speed);
  const Strip strip = strip_beside(index, piece, s, *target, side, request.force, needed);
  if (strip.ends_at_paint && strip.length <= 0.0) {
    return refused("the paint between lane '", place.lane_id, "' and lane '", network.lane(*target).source.id,
                   "' must not be crossed", request.force ? ": it is a curb" : "");
  }
  if (strip.length < needed) {
    return refused("lane '", network.lane(*target).source.id, "' can be changed to for ", strip.length,
                   " m more, but ", needed, " m are needed",
                   strip.ends_at_paint ? ": solid paint begins" : "");
  }
  const std::size_t next = index.next_waypoint({piece, s});
  const double to_waypoint =
      index.distance_to_destination({piece, s}) - index.distance_to_destination(index.waypoints()[next]);
  if (to_waypoint < needed) {
    return refused("waypoint ", next, " of the route comes first, in ", to_waypoint, " m: ", needed,
                   " m are needed");
  }
  std::size_t last = 0;
  SearchRequest places;
  places.places.push_back(place_along(strip, network, needed, last));
  const auto& waypoints = map.route()->waypoints;
  for (std::size_t i = next; i < waypoints.size(); ++i)
    places.places.push_back({waypoints[i].lane_id, waypoints[i].s});
  SearchResult found = search.find(places);
  if (!found.route) return refused("from the target no way leads to the destination: ", found.why_not);

  LaneChangePlan plan;
  plan.side = side;
  for (const LanePiece& lanes : strip.own) plan.from.push_back(network.lane(lanes.lane).source.id);
  for (const LanePiece& lanes : strip.target) plan.to.push_back(network.lane(lanes.lane).source.id);
  plan.route = joined(network, strip, last, side, place, std::move(*found.route));
  plan.route.id = map.route()->id;
  plan.route.distance += needed;
  return plan;
}

LaneChangePlan plan_lane_change(const RelativeMap& map, const std::string& own, double speed,
                                const LaneChangeParam& param, const LaneChangeRequest& request) {
  const auto find = [&](const std::string& id) {
    return std::find_if(map.lanes.begin(), map.lanes.end(),
                        [&](const Lane& lane) { return !id.empty() && lane.id == id; });
  };
  const auto lane = find(own);
  if (lane == map.lanes.end()) return refused("the vehicle is on no lane of the relative map");
  ChangeLane side = request.to == LaneChangeGoal::kRight ? ChangeLane::kRight : ChangeLane::kLeft;
  if (request.to == LaneChangeGoal::kLane) {
    if (find(request.lane_id) == map.lanes.end())
      return refused("lane '", request.lane_id, "' is not on the relative map");
    if (lane->right_neighbor_id == request.lane_id) side = ChangeLane::kRight;
    if (lane->left_neighbor_id != request.lane_id && lane->right_neighbor_id != request.lane_id)
      return refused("lane '", request.lane_id, "' does not lie beside lane '", own,
                     "', which the vehicle is on");
  }
  const bool left = side == ChangeLane::kLeft;
  const auto target = find(left ? lane->left_neighbor_id : lane->right_neighbor_id);
  if (target == map.lanes.end())
    return refused("there is no lane to the ", name_of_side(side), " of lane '", own, "'");
  // Paint is known from the start of the lane on, which may lie behind the vehicle.
  const LaneBoundary& boundary = left ? lane->left_boundary : lane->right_boundary;
  Polyline points;
  for (const PathPoint& point : lane->path) points.push_back(point.position);
  const double free = free_paint(boundary.paint, LaneLine(points).project(Point2::Zero()).s, request.force);
  if (free <= 0.0)
    return refused("the paint between lane '", own, "' and lane '", target->id, "' must not be crossed");
  const double needed = param.needed(speed), length = std::min(free, target->remaining_distance);
  if (length < needed)
    return refused("lane '", target->id, "' can be changed to for ", length, " m more, but ", needed,
                   " m are needed");
  LaneChangePlan plan;
  plan.side = side;
  plan.from = {own};
  plan.to = {target->id};
  return plan;
}

}  // namespace relative_map::core
