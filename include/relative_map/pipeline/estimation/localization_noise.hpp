#pragma once

#include <Eigen/Core>

#include "relative_map/model/sensor_noise.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

/// How noisy this vehicle's localization is, measured as it drives.
class LocalizationNoiseMeter {
 public:
  explicit LocalizationNoiseMeter(const LocalizationNoise& expected);

  /// Two poses in a row: what the second is off by from where odometry leads from the first tells the white
  /// noise.
  void listen(const VehicleState& from, const VehicleState& to);
  /// Localization's bias is `lateral` [m] (known to `stddev`) on this side of the way, where paint shows it:
  /// how it changes from one such place to the next tells how fast it walks.
  void see_bias(Time stamp, const Point2& normal, const Point2& bias, double stddev);
  /// What was known of the bias no longer compares: after a jump, or on another line.
  void lose_bias() { known_bias_ = false; }

  double position_stddev() const;  ///< [m] white
  double heading_stddev() const;   ///< [rad] white
  double position_walk() const;    ///< [m/sqrt(s)]

 private:
  LocalizationNoise expected_;
  double position_variance_, heading_variance_;  ///< [m^2], [rad^2]
  Eigen::Vector3d steady_ =
      Eigen::Vector3d::Zero();  ///< along, aside [m/s], turn [rad/s]: odometry's own error
  double walk_variance_;        ///< [m^2/s]
  bool known_bias_ = false;
  Time bias_stamp_{};
  Point2 bias_ = Point2::Zero();
  double bias_stddev_ = 0.0;
};

}  // namespace relative_map::core
