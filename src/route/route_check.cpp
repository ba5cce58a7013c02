#include "relative_map/route/route_check.hpp"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <sstream>

#include "route_index_builder.hpp"

namespace relative_map::core {

namespace {

using Fault = std::optional<std::string>;

constexpr double kJoint = 1e-3;  // [m] two pieces of one lane meet within this

template <class... Parts>
Fault fault(const Parts&... parts) {
  std::ostringstream text;
  (text << ... << parts);
  return text.str();
}

Fault check_status(const RouteUpdate& update, const RouteIndex*) {
  const bool ok = update.status.code == RouteCode::kOk;
  if (ok && update.segments.empty()) return fault("the status is OK, but there are no segments");
  if (!ok && !update.segments.empty()) return fault("there are segments, but the status is not OK");
  if (ok && !update.place) return fault("there are segments, but no place");
  if (!ok && update.status.message.empty()) return fault("the status does not say why there are no segments");
  return std::nullopt;
}

Fault check_own(const RouteUpdate& update, const RouteIndex*) {
  if (update.segments.empty()) return std::nullopt;
  const auto own = std::count_if(update.segments.begin(), update.segments.end(),
                                 [](const RouteSegments& segments) { return segments.is_on_segment; });
  if (own != 1) return fault("the vehicle is on ", own, " passages");
  const RouteSegments& first = update.segments.front();
  if (!first.is_on_segment) return fault("the own passage is not the first one");
  if (first.is_neighbor) return fault("the own passage is its own neighbor");
  return std::nullopt;
}

Fault check_ids(const RouteUpdate& update, const RouteIndex*) {
  std::set<std::string> ids;
  for (const RouteSegments& segments : update.segments) {
    if (segments.id.empty()) return fault("a passage has no id");
    if (!ids.insert(segments.id).second) return fault("two passages are called '", segments.id, "'");
  }
  return std::nullopt;
}

Fault check_pieces(const RouteUpdate& update, const RouteIndex*) {
  for (const RouteSegments& segments : update.segments) {
    if (segments.segments.empty()) return fault("passage ", segments.id, " has no segment");
    if (!std::isfinite(segments.s)) return fault("passage ", segments.id, " has an s that is not finite");
    for (const LaneSegment& piece : segments.segments) {
      if (std::isfinite(piece.start_s) && std::isfinite(piece.end_s) && piece.start_s < piece.end_s) continue;
      return fault("passage ", segments.id, " has [", piece.start_s, ", ", piece.end_s, "] of lane '",
                   piece.lane_id, "'");
    }
  }
  return std::nullopt;
}

Fault check_place(const RouteUpdate& update, const RouteIndex* index) {
  if (!update.place) return std::nullopt;
  const RoutePlace& place = *update.place;
  if (!std::isfinite(place.s) || !std::isfinite(place.l) || std::isnan(place.distance_to_destination)) {
    return fault("the place is not finite");
  }
  if (index == nullptr || update.segments.empty()) return std::nullopt;
  const std::string id = std::to_string(place.road) + "_" + std::to_string(place.passage);
  if (update.segments.front().id != id)
    return fault("the vehicle is on passage ", id, ", but ", update.segments.front().id, " is its own");
  if (place.next_waypoint >= index->waypoints().size())
    return fault("the next waypoint is ", place.next_waypoint, " of ", index->waypoints().size());
  return std::nullopt;
}

Fault check_actions(const RouteUpdate& update, const RouteIndex*) {
  for (const RouteSegments& segments : update.segments) {
    const bool stays = segments.previous_action == ChangeLane::kForward;
    if (segments.is_on_segment && !stays)
      return fault("a lane change leads to the own passage ", segments.id);
    if (!segments.is_on_segment && stays) return fault("no lane change leads to passage ", segments.id);
    if (!segments.can_exit && segments.next_action == ChangeLane::kForward && !update.segments.empty() &&
        update.segments.size() > 1 && segments.is_on_segment) {
      return fault("the own passage ", segments.id, " goes on, but there is one to change to");
    }
  }
  return std::nullopt;
}

Fault check_priority(const RouteUpdate& update, const RouteIndex*) {
  if (update.segments.empty()) return std::nullopt;
  const auto best = std::count_if(update.segments.begin(), update.segments.end(),
                                  [](const RouteSegments& segments) { return segments.priority == 0; });
  return best == 1 ? Fault() : fault(best, " passages have priority 0");
}

Fault check_count(const RouteUpdate& update, const RouteIndex*) {
  return update.segments.size() <= 2 ? Fault() : fault("there are ", update.segments.size(), " passages");
}

Fault check_lanes(const RouteUpdate& update, const RouteIndex* index) {
  for (const RouteSegments& segments : update.segments) {
    for (const LaneSegment& piece : segments.segments) {
      const auto lane = index->network().find(piece.lane_id);
      if (!lane) return fault("lane '", piece.lane_id, "' is not in the lane graph");
      const double length = index->network().lane(*lane).length();
      if (piece.start_s < 0.0 || piece.end_s > length + kJoint) {
        return fault("[", piece.start_s, ", ", piece.end_s, "] is not on lane '", piece.lane_id, "' of ",
                     length, " m");
      }
    }
  }
  return std::nullopt;
}

Fault check_continuity(const RouteUpdate& update, const RouteIndex* index) {
  const LaneNetwork& network = index->network();
  for (const RouteSegments& segments : update.segments) {
    for (std::size_t i = 1; i < segments.segments.size(); ++i) {
      const LaneSegment &before = segments.segments[i - 1], &after = segments.segments[i];
      const std::size_t from = *network.find(before.lane_id), to = *network.find(after.lane_id);
      const Point2 end = network.lane(from).line.point_at(before.end_s);
      const Point2 start = network.lane(to).line.point_at(after.start_s);
      const auto& successors = network.lane(from).successors;
      const bool follows = std::find(successors.begin(), successors.end(), to) != successors.end() &&
                           before.end_s > network.lane(from).length() - kOnPiece && after.start_s < kOnPiece;
      if (!follows && (end - start).norm() > 1.0) {
        return fault("passage ", segments.id, " jumps from lane '", before.lane_id, "' at ", before.end_s,
                     " m to lane '", after.lane_id, "' at ", after.start_s, " m");
      }
    }
  }
  return std::nullopt;
}

Fault check_end(const RouteUpdate& update, const RouteIndex* index) {
  if (update.segments.empty()) return std::nullopt;
  for (const RouteSegments& segments : update.segments) {
    if (segments.stop_for_destination && update.place->next_waypoint + 1 != index->waypoints().size())
      return fault("passage ", segments.id, " stops for the destination before the last waypoint");
    if (!segments.route_end) continue;
    const LanePosition& end = *segments.route_end;
    const bool on_it =
        std::any_of(segments.segments.begin(), segments.segments.end(), [&](const LaneSegment& piece) {
          return piece.lane_id == end.lane_id && piece.start_s <= end.s + kOnPiece &&
                 end.s <= piece.end_s + kOnPiece;
        });
    if (!on_it)
      return fault("the end of passage ", segments.id, " at ", end.s, " m of lane '", end.lane_id,
                   "' does not lie on it");
  }
  return std::nullopt;
}

struct Row {
  const char* name;
  Fault (*check)(const RouteUpdate&, const RouteIndex*);
};

constexpr Row kPlainRows[] = {{"status", check_status},    {"own", check_own},     {"ids", check_ids},
                              {"pieces", check_pieces},    {"place", check_place}, {"actions", check_actions},
                              {"priority", check_priority}};
/// Rows that need a lane graph, and pieces that are some.
constexpr Row kGraphRows[] = {
    {"count", check_count}, {"lanes", check_lanes}, {"continuity", check_continuity}, {"end", check_end}};

}  // namespace

std::vector<std::string> route_check_rows() {
  std::vector<std::string> names;
  for (const Row& row : kPlainRows) names.emplace_back(row.name);
  for (const Row& row : kGraphRows) names.emplace_back(row.name);
  return names;
}

std::vector<RouteViolation> check_route(const RouteUpdate& update, const RouteIndex* index) {
  std::vector<RouteViolation> violations;
  for (const Row& row : kPlainRows) {
    if (Fault found = row.check(update, index)) violations.push_back({row.name, *found});
  }
  if (!violations.empty() || index == nullptr) return violations;
  for (const Row& row : kGraphRows) {
    if (Fault found = row.check(update, index)) violations.push_back({row.name, *found});
    if (!violations.empty() && row.check == check_lanes) break;  // the rest looks lanes up
  }
  return violations;
}

RouteUpdate checked(RouteUpdate update, const RouteIndex* index) {
  const std::vector<RouteViolation> violations = check_route(update, index);
  if (violations.empty()) return update;
  RouteUpdate empty;
  empty.status.code = RouteCode::kContractViolation;
  for (const RouteViolation& violation : violations) {
    empty.status.message +=
        (empty.status.message.empty() ? "" : "; ") + violation.row + ": " + violation.what;
  }
  return empty;
}

}  // namespace relative_map::core
