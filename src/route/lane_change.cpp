#include "relative_map/route/lane_change.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include "relative_map/model/check_range.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kSure = 2;  // updates in a row

}  // namespace

std::vector<std::string> LaneChangeParam::validate() const {
  std::vector<std::string> faults;
  check_range("least_length", least_length, 1.0, 1000.0, faults);
  check_range("duration", duration, 0.0, 60.0, faults);
  check_range("timeout", timeout, 0.1, 1000.0, faults);
  check_range("done_offset", done_offset, 0.01, 2.0, faults);
  return faults;
}

double LaneChangeParam::needed(double speed) const {
  return std::max(least_length, std::isfinite(speed) ? duration * speed : 0.0);
}

void LaneChange::begin(const std::vector<std::string>& from, const std::vector<std::string>& to,
                       ChangeLane side, double now) {
  from_ = {from.begin(), from.end()};
  to_ = {to.begin(), to.end()};
  begun_ = now;
  on_target_ = 0;
  status_ = {LaneChangeState::kChanging, from.front(), to.front(), side, "", now};
}

void LaneChange::update(const RouteUpdate& update, double now) {
  if (!is_on()) return;
  if (now < begun_) return end(LaneChangeState::kAbandoned, "time has gone back", now);
  if (now - begun_ > param_.timeout) {
    std::ostringstream text;
    text << "the vehicle has not come to lane '" << status_.to_lane << "' within " << param_.timeout << " s";
    return end(LaneChangeState::kTimedOut, text.str(), now);
  }
  const RouteCode code = update.status.code;
  if (code == RouteCode::kOffRoute || code == RouteCode::kWrongWay || code == RouteCode::kRouteEnd)
    return end(LaneChangeState::kAbandoned, update.status.message, now);
  if (!update.place) return;
  // The vehicle may already have driven off the target's lanes, along the route.
  const RoutePlace& place = *update.place;
  const bool farther = place.road > 0 || place.passage > 0;
  const bool there = from_.count(place.lane_id) == 0 && (to_.count(place.lane_id) > 0 || farther) &&
                     std::abs(place.l) <= param_.done_offset;
  on_target_ = there ? on_target_ + 1 : 0;
  if (on_target_ >= kSure) end(LaneChangeState::kDone, "", now);
}

void LaneChange::abandon(const std::string& why, double now) {
  if (is_on()) end(LaneChangeState::kAbandoned, why, now);
}

void LaneChange::end(LaneChangeState state, const std::string& message, double now) {
  status_.state = state;
  status_.message = message;
  status_.time = now;
}

void LaneChange::raise_target(RouteUpdate& update) const {
  if (!is_on() || update.segments.empty()) return;
  const auto own = update.segments.begin();
  if (from_.count(update.place ? update.place->lane_id : "") == 0) return;  // it is on the target
  const auto target = std::find_if(own + 1, update.segments.end(), [&](const RouteSegments& segments) {
    return segments.is_neighbor && segments.previous_action == status_.side;
  });
  if (target != update.segments.end()) std::swap(own->priority, target->priority);
}

}  // namespace relative_map::core
