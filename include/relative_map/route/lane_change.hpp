#pragma once

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "relative_map/model/route_segments.hpp"

namespace relative_map::core {

struct LaneChangeParam {
  double least_length = 20.0;  ///< [m] that the lanes must lie beside each other, ahead
  double duration = 4.0;       ///< [s] that a lane change takes: at speed, more length is needed
  double timeout = 20.0;       ///< [s] after which it is given up
  double done_offset = 0.5;    ///< [m] beside the target's centerline the vehicle has come there

  std::vector<std::string> validate() const;
  /// [m] that a lane change needs at a speed [m/s].
  double needed(double speed) const;
};

/// Numbers of the message LaneChange.
enum class LaneChangeState : std::uint8_t {
  kNone = 0,
  kChanging = 1,
  kDone = 2,
  kTimedOut = 3,
  kAbandoned = 4,
};

struct LaneChangeStatus {
  LaneChangeState state = LaneChangeState::kNone;
  std::string from_lane, to_lane;
  ChangeLane side = ChangeLane::kForward;
  std::string message;
  double time = 0.0;  ///< [s] of the last step
};

/// One lane change: from when it is accepted until it is done, timed out or abandoned. What it knows of the
/// vehicle is the lane that it is on.
class LaneChange {
 public:
  explicit LaneChange(const LaneChangeParam& param) : param_(param) {}

  bool is_on() const { return status_.state == LaneChangeState::kChanging; }
  const LaneChangeStatus& status() const { return status_; }

  /// `from` and `to` are lanes one after the other, the first ones beside the vehicle. Not while one is on.
  void begin(const std::vector<std::string>& from, const std::vector<std::string>& to, ChangeLane side,
             double now);
  /// What was told of the vehicle: it may have come to the target, be out of time, or have left the route. On
  /// the target it must be found twice in a row: one stray pose is no lane change.
  void update(const RouteUpdate& update, double now);
  void abandon(const std::string& why, double now);

  /// While it is on, what leads to the target is to be driven on: priority 0.
  void raise_target(RouteUpdate& update) const;

 private:
  void end(LaneChangeState state, const std::string& message, double now);

  LaneChangeParam param_;
  LaneChangeStatus status_;
  std::set<std::string> from_, to_;
  double begun_ = 0.0;         ///< [s]
  std::size_t on_target_ = 0;  ///< updates in a row
};

}  // namespace relative_map::core
