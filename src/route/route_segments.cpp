#include "relative_map/route/route_segments.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/route/passage_choice.hpp"
#include "relative_map/route/route_line.hpp"
#include "route_index_builder.hpp"

namespace relative_map::core {

namespace {

RouteSegments segments_of(const RouteIndex& index, const PassageRange& passage, const RouteLine& line) {
  RouteSegments segments;
  segments.id = std::to_string(passage.road) + "_" + std::to_string(passage.passage);
  segments.next_action = passage.change_lane;
  segments.can_exit = passage.can_exit;
  for (const LanePiece& piece : line.pieces) {
    segments.segments.push_back({index.network().lane(piece.lane).source.id, piece.start, piece.end});
  }
  if (line.has_passage_end) {
    segments.route_end =
        LanePosition{index.lane_of(passage.end - 1).source.id, index.pieces()[passage.end - 1].end};
  }
  return segments;
}

/// Where the vehicle is beside a passage; none where it is before its start or past its end.
std::optional<TrackedPlace> place_beside(const RouteIndex& index, const PassageRange& passage,
                                         const Pose2& pose, double max_distance, double to_destination) {
  std::optional<TrackedPlace> best;
  double best_cost = std::numeric_limits<double>::infinity(), best_detour = 0.0;
  for (const std::size_t lane : index.network().lanes_near(pose.position(), max_distance)) {
    for (const std::size_t number : index.pieces_on(lane)) {
      if (number < passage.first || number >= passage.end) continue;
      const RoutePiece& piece = index.pieces()[number];
      const LaneProjection projection = index.lane_of(number).line.project(pose.position());
      const double s = std::clamp(projection.s, piece.start, piece.end);
      const double gap = std::abs(std::clamp(projection.s, 0.0, index.lane_of(number).length()) - s);
      const double cost = projection.distance + gap;
      const double detour = std::abs(index.distance_to_destination({number, s}) - to_destination);
      const bool same = std::abs(cost - best_cost) < 1e-3;
      if (same ? detour >= best_detour : cost > best_cost) continue;
      best_cost = cost;
      best_detour = detour;
      best = TrackedPlace{{number, s}, projection.s, projection.l};
    }
  }
  if (!best) return std::nullopt;
  const bool before =
      best->place.piece == passage.first && best->s < index.pieces()[passage.first].start - kOnPiece;
  const bool past =
      best->place.piece + 1 == passage.end && best->s > index.pieces()[passage.end - 1].end + kOnPiece;
  if (before || past) return std::nullopt;
  return best;
}

/// Whether a vehicle on its own lane can change to a place beside it: near, in the same direction, with no
/// more between the lanes than a line.
bool can_change(const RouteIndex& index, const RouteParam& param, const TrackedPlace& own,
                const TrackedPlace& other) {
  const LaneNetwork::Lane &from = index.lane_of(own.place.piece), &to = index.lane_of(other.place.piece);
  const double from_s = own.place.s, to_s = other.place.s;
  const Point2 here = from.line.point_at(from_s), there = to.line.point_at(to_s);
  const double heading = to.line.heading_at(to_s);
  if (std::abs(angle_difference(from.line.heading_at(from_s), heading)) > param.max_heading) return false;
  const double distance = (here - there).norm();
  if (distance > param.max_lane_change_distance) return false;
  const bool here_is_left = cross(Point2(std::cos(heading), std::sin(heading)), here - there) > 0.0;
  const double facing = here_is_left ? to.left_half_width(to_s) : to.right_half_width(to_s);
  const double near = here_is_left ? from.right_half_width(from_s) : from.left_half_width(from_s);
  const bool widths_known = near > 0.0 && facing > 0.0;
  return !widths_known || distance <= near + facing + param.lane_gap;
}

}  // namespace

std::vector<RouteSegments> segments_around(const RouteIndex& index, const RouteParam& param,
                                           const TrackedPlace& place, const Pose2& pose, double speed) {
  const double ahead = param.ahead(speed);
  const double to_destination = index.distance_to_destination(place.place);
  const bool stop = index.next_waypoint(place.place) + 1 == index.waypoints().size() &&
                    (!index.destination_comes_twice() || to_destination <= ahead);

  const RouteLine own_line = line_through(index, place.place, param.look_back, ahead);
  RouteSegments own = segments_of(index, index.passage_of(place.place.piece), own_line);
  own.is_on_segment = true;
  own.stop_for_destination = stop;
  own.s = own_line.behind + place.s - place.place.s;
  const auto next = next_passage(index, place.place);
  if (next) own.change = change_zone(index, place.place, *next);
  std::vector<RouteSegments> result{own};
  if (!next) return result;
  const PassageRange& passage = index.passages()[*next];
  const auto other = place_beside(index, passage, pose, param.max_lane_change_distance, to_destination);
  if (!other || !can_change(index, param, place, *other)) return result;
  const RouteLine line = line_through(index, other->place, param.look_back, ahead);
  RouteSegments beside = segments_of(index, passage, line);
  beside.is_neighbor = true;
  beside.previous_action = other->l > 0.0 ? ChangeLane::kRight : ChangeLane::kLeft;
  beside.stop_for_destination = stop;
  beside.s = line.behind + other->s - other->place.s;
  beside.priority = 1;
  if (!beside.segments.empty()) result.push_back(beside);
  return result;
}

}  // namespace relative_map::core
