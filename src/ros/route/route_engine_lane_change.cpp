// Lane changes that were asked for, on a lane graph and on a relative map.
#include "relative_map/ros/route/route_engine.hpp"

namespace relative_map {

namespace {

core::LaneChangeGoal opposite(core::ChangeLane side) {
  return side == core::ChangeLane::kLeft ? core::LaneChangeGoal::kRight : core::LaneChangeGoal::kLeft;
}

}  // namespace

LaneChangeAnswer RouteEngine::take_back(const ros::Time& now) {
  if (change_.is_on()) {
    const LaneChangeAnswer answer{"", change_.status().from_lane};
    change_.abandon("it was taken back", now.toSec());
    restore_way();
    return answer;
  }
  if (change_.status().state != core::LaneChangeState::kDone)
    return {"there is no lane change to take back", ""};
  core::LaneChangeRequest request;
  request.to = opposite(change_.status().side);
  return change_lane(request, now);
}

LaneChangeAnswer RouteEngine::change_lane(const core::LaneChangeRequest& request, const ros::Time& now) {
  if (request.to == core::LaneChangeGoal::kBack) return take_back(now);
  if (change_.is_on())
    return {"a lane change to lane '" + change_.status().to_lane + "' is on: it must end, or be taken back",
            ""};
  if (last_.status.code != core::RouteCode::kOk) return {last_.status.message, ""};
  if (!last_.place) return {"nothing is known yet of where the vehicle is", ""};
  const bool on_map = config_.source == RouteSource::kRelativeMap;
  const core::LaneChangePlan plan =
      on_map
          ? core::plan_lane_change(last_map_, last_.place->lane_id, speed(now), config_.lane_change, request)
          : core::plan_lane_change(map_, *search_, *last_.place, speed(now), config_.lane_change, request);
  if (!plan.why_not.empty()) return {plan.why_not, ""};
  if (on_map) {
    preferred_before_ = preferred_lane_;
    preferred_lane_ = plan.to.front();
  } else {
    const std::optional<core::Route> before = map_.route();
    const core::RouteStatus status = map_.set_route(plan.route);
    if (status.code != core::RouteCode::kOk) return {status.message, ""};
    way_before_ = before;
    if (!asked_route_) asked_route_ = before;
  }
  change_.begin(plan.from, plan.to, plan.side, now.toSec());
  return {"", plan.to.front()};
}

void RouteEngine::restore_way() {
  preferred_lane_ = preferred_before_;
  if (way_before_) map_.set_route(*way_before_);
  way_before_.reset();
}

bool RouteEngine::note_lane_change(const core::RouteUpdate& update, const ros::Time& now) {
  if (!change_.is_on()) return false;
  change_.update(update, now.toSec());
  const core::LaneChangeState state = change_.status().state;
  if (change_.is_on()) return false;
  if (state != core::LaneChangeState::kDone) {
    restore_way();
  } else if (way_before_) {
    // The waypoint that led over the target has served: it must not keep the vehicle there.
    core::Route on = *map_.route();
    on.waypoints.erase(on.waypoints.begin() + 1);
    map_.set_route(on);
    way_before_.reset();
  }
  return true;
}

void RouteEngine::prefer_lane(core::RelativeMap& map, const ros::Time& now) {
  if (preferred_lane_.empty() || map.lanes.empty()) return;
  bool found = false;
  for (const core::Lane& lane : map.lanes) found = found || lane.id == preferred_lane_;
  if (!found) {
    change_.abandon("lane '" + preferred_lane_ + "' is not on the relative map any more", now.toSec());
    preferred_lane_.clear();
    preferred_before_.clear();
    return;
  }
  for (core::Lane& lane : map.lanes) lane.priority = lane.id == preferred_lane_ ? 0 : lane.priority + 1;
}

}  // namespace relative_map
