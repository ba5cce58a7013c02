#pragma once

#include <cstdint>

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
  double heading_bias(double time);                        ///< [rad], likewise
  double yaw_rate_bias() const { return yaw_rate_bias_; }  ///< [rad/s]

 private:
  Point2 drift(double time) const;

  LocalizationErrorParam param_;
  OrnsteinUhlenbeck bias_x_, bias_y_, heading_;
  Point2 drift_direction_ = Point2::UnitX();
  double drift_phase_ = 0.0;    ///< [rad]
  double yaw_rate_bias_ = 0.0;  ///< [rad/s]
};

}  // namespace relative_map::core
