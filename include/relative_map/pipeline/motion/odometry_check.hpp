#pragma once

#include <optional>

#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

/// Whether speed and yaw rate are those that the poses show. A chassis that reports 0, or km/h, or a yaw rate
/// to the right is worse than none. Trust is lost by two verdicts in a row, since localization jumps now and
/// then, and won back likewise; who stands, or drives straight on, tells nothing.
class OdometryCheck {
 public:
  /// A pose with speed and yaw rate as they were given (NaN: not given), by rising stamps.
  void add(const VehicleState& given);
  bool trusts_speed() const { return way_.trusted; }
  bool trusts_yaw_rate() const { return turn_.trusted; }

 private:
  /// One of the two, from a pose on.
  struct Course {
    VehicleState begin;
    VehicleState middle;    ///< half way of a verdict
    double integral = 0.0;  ///< [m] or [rad] since then
    int seconds = 0;        ///< since then that have been looked at
    bool trusted = true;
    int against = 0;  ///< verdicts in a row

    void restart(const VehicleState& from);
    /// Whether another second has passed up to `now`.
    bool is_due(const VehicleState& now);
    void judge(bool agrees);
  };
  void look_at_way(const VehicleState& now);
  void look_at_turn(const VehicleState& now);
  void restart_turn(const VehicleState& from);

  std::optional<VehicleState> last_;
  Course way_, turn_;
  double residual_ = 0.0;           ///< [rad] that the headings have turned, less the yaw rate's integral
  double smoothed_ = 0.0;           ///< [rad] the same without the headings' noise, ...
  double smoothed_at_begin_ = 0.0;  ///< ... and where turn_ begins
};

}  // namespace relative_map::core
