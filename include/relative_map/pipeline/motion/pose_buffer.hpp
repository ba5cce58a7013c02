#pragma once

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/pipeline/motion/odometry_check.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

/// The latest poses, to look up where the vehicle was when an image was taken, and the speed and the yaw rate
/// that are believed.
class PoseBuffer {
 public:
  /// A stamp at or before the newest one's replaces what came after it: time has been set back.
  /// Where localization jumps the vehicle does not: the poses before are put to where they lie from the new
  /// one by odometry, so that what was seen from them is still there. A speed or a yaw rate that is not
  /// given, or that is not what the poses show (OdometryCheck), comes from the poses before, and a yaw rate
  /// that seems never to be filled.
  void add(const VehicleState& state);
  /// Interpolated between poses, carried on by speed and yaw rate a little beyond them; none further out.
  std::optional<Pose2> at(Time stamp) const;
  /// With its speed and yaw rate; there must be one.
  const VehicleState& newest() const { return states_.back(); }
  /// Faults of speed and yaw rate that the poses show, a sentence each. `speed_field`: what gave the speed.
  std::vector<std::string> remarks(const std::string& speed_field) const;
  bool trusts_speed() const { return odometry_.trusts_speed(); }
  bool trusts_odometry() const { return odometry_.trusts_speed() && odometry_.trusts_yaw_rate(); }
  void clear();
  /// How long ago the oldest question may be about.
  void keep(Duration kept) { kept_ = kept; }

 private:
  /// The first of the states before the newest that is not older; none: null.
  const VehicleState* first_since(Time stamp) const;
  // Of the newest state, by the poses before it; 0 without any.
  double turn_rate() const;
  double speed_along() const;

  void follow_jump(const VehicleState& to);

  Duration kept_ = std::chrono::seconds(3);
  OdometryCheck odometry_;
  VehicleState given_;               ///< the newest one, as it came
  std::deque<VehicleState> states_;  ///< by rising stamp
  Time last_turn_{};                 ///< of the newest yaw rate that was not exactly 0
};

}  // namespace relative_map::core
