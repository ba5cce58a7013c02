#include "route_json.hpp"

#include <cmath>
#include <set>
#include <string>

namespace relative_map {

namespace {

using Json = nlohmann::json;

/// The run of segments around the vehicle's, as the original tells it: from the one before it up to the first
/// lane that comes twice. The tracker here does not need it.
Json range_of(const core::RouteIndex& index, std::size_t segment) {
  std::set<std::size_t> seen;
  const std::size_t start = segment == 0 ? 0 : segment - 1;
  std::size_t end = start;
  for (const core::RoutePiece& piece : index.pieces()) {
    if (piece.segment < start) continue;
    if (!seen.insert(piece.lane).second) break;
    end = piece.segment + 1;
  }
  return Json::array({start, end});
}

Json json_of(const core::RouteSegments& segments) {
  Json lanes = Json::array();
  for (const core::LaneSegment& segment : segments.segments) {
    lanes.push_back({segment.lane_id, rounded(segment.start_s), rounded(segment.end_s)});
  }
  Json object;
  object["id"] = segments.id;
  object["on_segment"] = segments.is_on_segment;
  object["can_exit"] = segments.can_exit;
  object["next_action"] = name_of(segments.next_action);
  object["previous_action"] = name_of(segments.previous_action);
  object["stop_for_destination"] = segments.stop_for_destination;
  object["route_end"] = nullptr;
  if (segments.route_end) {
    object["route_end"] = Json::array({segments.route_end->lane_id, rounded(segments.route_end->s)});
  }
  object["length"] = rounded(segments.length());
  object["lanes"] = lanes;
  return object;
}

}  // namespace

double rounded(double value) {
  return std::round(value * 1e6) / 1e6 + 0.0;
}

const char* name_of(core::ChangeLane change) {
  constexpr const char* kNames[] = {"FORWARD", "LEFT", "RIGHT"};
  return kNames[static_cast<std::size_t>(change)];
}

Json json_of(const core::ReferenceLine& line) {
  Json points = Json::array();
  for (const core::ReferencePoint& point : line.points) {
    points.push_back({rounded(point.path.position.x()), rounded(point.path.position.y()), point.path.theta,
                      point.path.kappa, rounded(point.path.s)});
  }
  return points;
}

Json json_of(const core::RouteUpdate& update, const core::RouteIndex* index) {
  if (update.status.code != core::RouteCode::kOk) return {{"refused", update.status.message}};
  Json object;
  if (update.place) {
    const core::RoutePlace& place = *update.place;
    object["lane"] = place.lane_id;
    object["s"] = rounded(place.s);
    object["l"] = rounded(place.l);
    object["route_index"] = place.segment;
    object["road_passage_place"] = {place.road, place.passage, place.position};
    object["next_waypoint"] = place.next_waypoint;
    if (index != nullptr) object["range"] = range_of(*index, place.segment);
    object["distance_to_destination"] = rounded(place.distance_to_destination);
  }
  object["segments"] = Json::array();
  for (const core::RouteSegments& segments : update.segments) object["segments"].push_back(json_of(segments));
  return object;
}

}  // namespace relative_map
