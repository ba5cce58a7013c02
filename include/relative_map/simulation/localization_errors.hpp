#pragma once

#include <cstdint>
#include <optional>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/error_param.hpp"
#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

/// What a localization is wrong by for longer than a moment: biases that come and go, and a drift.
class LocalizationErrors {
 public:
  LocalizationErrors(const LocalizationErrorParam& param, std::uint64_t seed);

  /// [m] in the map frame, at times [s] since the start of the drive that never fall.
  Point2 position_bias(double time);
  double heading_bias(double time);                          ///< [rad], likewise
  double yaw_rate_bias() const { return yaw_rate_bias_; }    ///< [rad/s]
  double yaw_rate_scale() const { return yaw_rate_scale_; }  ///< [-] 1: right

 private:
  Point2 drift(double time) const;
  Point2 jump(double time);

  LocalizationErrorParam param_;
  OrnsteinUhlenbeck bias_x_, bias_y_, heading_;
  Point2 drift_direction_ = Point2::UnitX();
  double drift_phase_ = 0.0;    ///< [rad]
  double yaw_rate_bias_ = 0.0;  ///< [rad/s]
  double yaw_rate_scale_ = 1.0;
  Episodes jumps_;
  std::mt19937_64 jump_engine_;
  double jump_start_ = -1.0;  ///< [s] of the episode that jump_direction_ is of
  Point2 jump_direction_ = Point2::UnitX();
};

/// A pose that is summed up from motion which is measured a little wrong.
class PoseDrift {
 public:
  /// `speed_scale` and `yaw_rate_scale` [-] and `yaw_rate_bias` [rad/s] are those of the vehicle's sensors.
  PoseDrift(const PoseDriftParam& param, double speed_scale, double yaw_rate_scale, double yaw_rate_bias,
            std::uint64_t seed);

  /// Where the vehicle seems to be when it is at `truth`, at times [s] that never fall.
  Pose2 at(const Pose2& truth, double time);
  /// The vehicle has been put elsewhere: the pose is right again.
  void restart() { last_.reset(); }

 private:
  struct Last {
    Pose2 truth, seeming;
    double time;
  };
  PoseDriftParam param_;
  double distance_scale_ = 1.0, turn_scale_ = 1.0;  ///< [-]
  double yaw_rate_bias_ = 0.0;                      ///< [rad/s]
  NoiseSource walk_;
  std::mt19937_64 closures_;
  double next_closure_ = 0.0;  ///< [s]
  std::optional<Last> last_;
};

}  // namespace relative_map::core
