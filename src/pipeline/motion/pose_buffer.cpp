#include "relative_map/pipeline/motion/pose_buffer.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr Duration kTurnInterval = std::chrono::milliseconds(200);      // over which a turn is measured
constexpr Duration kSpeedInterval = std::chrono::milliseconds(500);     // over which a speed is measured
constexpr Duration kZeroInterval = std::chrono::seconds(1);             // of yaw rates of exactly 0
constexpr Duration kMaxExtrapolation = std::chrono::milliseconds(300);  // beyond the poses that are known

}  // namespace

void PoseBuffer::add(const VehicleState& state) {
  while (!states_.empty() && states_.back().stamp >= state.stamp) states_.pop_back();
  if (!states_.empty() && has_jumped(states_.back(), state)) follow_jump(state);
  if (state.yaw_rate != 0.0 || states_.empty()) last_turn_ = state.stamp;
  VehicleState given = state;
  const bool never_filled = state.yaw_rate == 0.0 && state.stamp - last_turn_ >= kZeroInterval;
  if (never_filled) given.yaw_rate = std::numeric_limits<double>::quiet_NaN();
  odometry_.add(given);
  given_ = given;
  states_.push_back(given);
  VehicleState& newest = states_.back();
  if (!std::isfinite(given.yaw_rate) || !odometry_.trusts_yaw_rate()) newest.yaw_rate = turn_rate();
  newest.speed_by_poses = !std::isfinite(given.speed) || !odometry_.trusts_speed();
  if (newest.speed_by_poses) newest.speed = speed_along();
  while (states_.front().stamp < state.stamp - kept_) states_.pop_front();
}

void PoseBuffer::clear() {
  const Duration kept = kept_;
  *this = PoseBuffer();
  kept_ = kept;
}

void PoseBuffer::follow_jump(const VehicleState& to) {
  const VehicleState& last = states_.back();
  const Pose2 expected = carried_on(last, to_seconds(to.stamp - last.stamp));
  for (VehicleState& state : states_) {
    state.map_from_base = to.map_from_base.to_parent(expected.to_local(state.map_from_base));
  }
}

const VehicleState* PoseBuffer::first_since(Time stamp) const {
  const auto found = std::find_if(states_.begin(), std::prev(states_.end()),
                                  [&](const VehicleState& candidate) { return candidate.stamp >= stamp; });
  return found->stamp < states_.back().stamp ? &*found : nullptr;
}

double PoseBuffer::turn_rate() const {
  const VehicleState &now = states_.back(), *earlier = first_since(now.stamp - kTurnInterval);
  if (!earlier) return 0.0;
  return angle_difference(now.map_from_base.heading(), earlier->map_from_base.heading()) /
         to_seconds(now.stamp - earlier->stamp);
}

double PoseBuffer::speed_along() const {
  const VehicleState &now = states_.back(), *earlier = first_since(now.stamp - kSpeedInterval);
  if (!earlier) return 0.0;
  const Point2 way = now.map_from_base.position() - earlier->map_from_base.position();
  const double turn = angle_difference(now.map_from_base.heading(), earlier->map_from_base.heading());
  // A chord leads where the heading is half way.
  return way.dot(Pose2(Point2::Zero(), now.map_from_base.heading() - 0.5 * turn).forward()) /
         to_seconds(now.stamp - earlier->stamp);
}

std::optional<Pose2> PoseBuffer::at(Time stamp) const {
  if (states_.empty()) return std::nullopt;
  const auto after = std::lower_bound(states_.begin(), states_.end(), stamp,
                                      [](const VehicleState& state, Time t) { return state.stamp < t; });
  if (after != states_.end() && after->stamp == stamp) return after->map_from_base;
  if (after == states_.begin() || after == states_.end()) {
    const VehicleState& end = after == states_.end() ? states_.back() : states_.front();
    const Duration beyond = stamp - end.stamp;
    if (beyond > kMaxExtrapolation || -beyond > kMaxExtrapolation) return std::nullopt;
    return carried_on(end, to_seconds(beyond));
  }
  const VehicleState &a = *(after - 1), &b = *after;
  const double weight = to_seconds(stamp - a.stamp) / to_seconds(b.stamp - a.stamp);
  const Point2 moved = b.map_from_base.position() - a.map_from_base.position();
  return Pose2(a.map_from_base.position() + weight * moved,
               interpolate_angle(a.map_from_base.heading(), b.map_from_base.heading(), weight));
}

std::vector<std::string> PoseBuffer::remarks(const std::string& speed_field) const {
  std::vector<std::string> remarks;
  const auto tell = [&](const std::string& field, double given, double shown, const char* unit) {
    std::ostringstream sentence;
    sentence.precision(3);
    sentence << field << " is " << given << unit << ", but the poses show " << shown << unit
             << ": the poses are believed";
    remarks.push_back(sentence.str());
  };
  if (!odometry_.trusts_speed()) tell(speed_field, given_.speed, newest().speed, " m/s");
  if (!odometry_.trusts_yaw_rate()) {
    tell("localization: pose.angular_velocity_vrf.z", given_.yaw_rate, newest().yaw_rate, " rad/s");
  }
  return remarks;
}

}  // namespace relative_map::core
