#include "relative_map/pipeline/motion/dead_reckoning.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr Duration kLongestPiece = std::chrono::seconds(1);             // that two states tell of
constexpr Duration kMaxExtrapolation = std::chrono::milliseconds(300);  // before and beyond the states

Pose2 gone_on(const Pose2& from, double speed, double yaw_rate, double seconds) {
  return carried_on({Time{}, from, speed, yaw_rate}, seconds);
}

}  // namespace

void DeadReckoning::add(const VehicleState& state) {
  if (!nodes_.empty() && state.stamp <= nodes_.back().stamp) return;
  const double speed = std::isfinite(state.speed) ? state.speed : speed_;
  const double yaw_rate = std::isfinite(state.yaw_rate) ? state.yaw_rate : yaw_rate_;
  if (!nodes_.empty() && state.stamp - nodes_.back().stamp > kLongestPiece) nodes_.clear();
  if (nodes_.empty()) {
    nodes_.push_back({state.stamp, Pose2(), 0.0, speed, yaw_rate});
  } else {
    Node& last = nodes_.back();
    last.speed = 0.5 * (speed_ + speed);
    last.yaw_rate = 0.5 * (yaw_rate_ + yaw_rate);
    const double seconds = to_seconds(state.stamp - last.stamp);
    nodes_.push_back({state.stamp, gone_on(last.pose, last.speed, last.yaw_rate, seconds),
                      last.way + std::abs(last.speed) * seconds, speed, yaw_rate});
  }
  speed_ = speed;
  yaw_rate_ = yaw_rate;
  while (nodes_.size() > 1 && nodes_[1].stamp < state.stamp - kept_) nodes_.pop_front();
}

std::optional<Time> DeadReckoning::newest() const {
  if (nodes_.empty()) return std::nullopt;
  return nodes_.back().stamp;
}

const DeadReckoning::Node* DeadReckoning::node_of(Time stamp, double& seconds) const {
  if (nodes_.empty() || stamp < nodes_.front().stamp - kMaxExtrapolation ||
      stamp > nodes_.back().stamp + kMaxExtrapolation) {
    return nullptr;
  }
  const auto after = std::upper_bound(nodes_.begin(), nodes_.end(), stamp,
                                      [](Time time, const Node& node) { return time < node.stamp; });
  const Node& node = after == nodes_.begin() ? *after : *std::prev(after);
  seconds = to_seconds(stamp - node.stamp);
  return &node;
}

std::optional<Pose2> DeadReckoning::at(Time stamp) const {
  double seconds = 0.0;
  const Node* node = node_of(stamp, seconds);
  if (!node) return std::nullopt;
  return gone_on(node->pose, node->speed, node->yaw_rate, seconds);
}

std::optional<Pose2> DeadReckoning::moved(Time from, Time to) const {
  const std::optional<Pose2> before = at(from), after = at(to);
  if (!before || !after) return std::nullopt;
  return before->to_local(*after);
}

std::optional<double> DeadReckoning::way(Time from, Time to) const {
  double since_from = 0.0, since_to = 0.0;
  const Node *before = node_of(from, since_from), *after = node_of(to, since_to);
  if (!before || !after) return std::nullopt;
  return after->way + std::abs(after->speed) * since_to - before->way - std::abs(before->speed) * since_from;
}

}  // namespace relative_map::core
