#include "relative_map/route/route_map.hpp"

#include <cmath>
#include <utility>

#include "relative_map/route/route_segments.hpp"

namespace relative_map::core {

namespace {

RouteUpdate refused(RouteCode code, const std::string& why) {
  RouteUpdate update;
  update.status = {code, why};
  return update;
}

bool finite(const Pose2& pose) {
  return pose.position().allFinite() && std::isfinite(pose.heading());
}

}  // namespace

RouteStatus RouteMap::set_graph(std::shared_ptr<const LaneNetwork> network) {
  network_ = std::move(network);
  index_.reset();
  tracker_.reset();
  repairs_.clear();
  if (!network_) {
    route_.reset();
    return {RouteCode::kNoGraph, "there is no lane graph"};
  }
  if (!route_) return {};
  const Route route = *route_;
  route_.reset();
  return take(route);
}

RouteStatus RouteMap::set_route(const Route& route) {
  if (!network_) return {RouteCode::kNoGraph, "a route has come, but there is no lane graph"};
  if (route_ && same_way(*route_, route)) return {};
  return take(route);
}

RouteStatus RouteMap::take(const Route& route) {
  RouteIndex::Result built = RouteIndex::build(network_, route);
  if (!built.index) return built.status;
  index_ = std::move(built.index);
  repairs_ = std::move(built.repairs);
  tracker_.emplace(index_, param_);
  route_ = route;
  return {};
}

void RouteMap::clear_route() {
  index_.reset();
  tracker_.reset();
  route_.reset();
  repairs_.clear();
}

RouteUpdate RouteMap::update(const std::optional<Pose2>& pose, double speed) {
  if (!network_) return refused(RouteCode::kNoGraph, "there is no lane graph");
  if (!index_) return refused(RouteCode::kNoRoute, "there is no route");
  if (!pose) return refused(RouteCode::kNoLocalization, "there is no localization");
  if (!finite(*pose)) return refused(RouteCode::kNoLocalization, "the vehicle's pose is not finite");
  const RouteTracker::Result tracked = tracker_->update(*pose);
  RouteUpdate update;
  update.status = tracked.status;
  if (!tracked.place) return update;

  const RoutePiece& piece = index_->pieces()[tracked.place->place.piece];
  const PassageRange& passage = index_->passage_of(tracked.place->place.piece);
  RoutePlace place;
  place.lane_id = index_->lane_of(tracked.place->place.piece).source.id;
  place.s = tracked.place->s;
  place.l = tracked.place->l;
  place.segment = piece.segment;
  place.road = passage.road;
  place.passage = passage.passage;
  place.position = piece.position;
  place.next_waypoint = index_->next_waypoint(tracked.place->place);
  place.distance_to_destination = index_->distance_to_destination({tracked.place->place.piece, place.s});
  update.place = place;
  update.segments = segments_around(*index_, param_, *tracked.place, *pose, speed);
  return update;
}

}  // namespace relative_map::core
