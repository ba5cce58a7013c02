#pragma once

#include <vector>

#include "relative_map/model/prediction_config.hpp"
#include "relative_map/prediction/situation.hpp"

namespace relative_map::core {

/// The speed that curves ahead allow on a way, every two metres from where the road user is.
class CurveLimits {
 public:
  CurveLimits() = default;
  /// Over `reach` [m] from s [m] on; no limit where nothing bends.
  CurveLimits(const LaneSequence& path, double s, double reach, double lateral_acceleration, double braking);
  /// [m/s] after `progress` [m]
  double at(double progress) const;

 private:
  std::vector<double> limits_;
};

/// How a driver goes on.
struct Driver {
  double speed = 0.0;         ///< [m/s] >= 0
  double acceleration = 0.0;  ///< [m/s^2] now
  double urge = 0.0;          ///< [m/s^2] more than that from now on, fading: the same driver in another mood
  double speed_limit = 0.0;   ///< [m/s] 0: not known
};

/// A leader with its own future.
struct LeadingVehicle {
  double gap = 0.0;  ///< [m] now
  const SpeedProfile* profile = nullptr;
};

/// The speed of a driver over the next 8 s. What it does now fades; behind a leader it goes over to the full
/// velocity difference model (Jiang, Wu and Zhu, 2001) with the headway that it is seen to keep; curves are
/// braked for. `leader` and `curves` may be null.
SpeedProfile drive(const Driver& driver, const LeadingVehicle* leader, const CurveLimits* curves,
                   const SpeedParam& param);

/// The greatest braking [m/s^2] that the curves of a way ask for; 0: none.
double braking_for_curves(const LaneSequence& path, double s, double speed, double reach,
                          double lateral_acceleration);

/// The futures of all, leaders before their followers, on the likeliest way of each. `ego` is the vehicle's
/// own profile, for those who follow it.
void drive_all(std::vector<Situation>& situations, const SpeedProfile& ego, double lateral_acceleration,
               const SpeedParam& param);

}  // namespace relative_map::core
