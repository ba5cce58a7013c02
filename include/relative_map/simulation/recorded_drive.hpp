#pragma once

#include <variant>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/accuracy_scenes.hpp"
#include "relative_map/simulation/true_road.hpp"

namespace relative_map::core {

/// A sensor's message, at the time when it arrives.
struct Delivery {
  Time time{};
  std::variant<Localization, Chassis, LaneMarkers> message;
};

/// Where the vehicle really was.
struct TruePose {
  Time stamp{};
  Pose2 path_from_base;  ///< in the frame of the road's path
  double s = 0.0;        ///< [m] along the road's reference curve
  double l = 0.0;        ///< [m] to the left of it
};

/// A drive that was simulated once, to be mapped as often as needed.
struct RecordedDrive {
  TrueRoad road;
  NavigationInfo navigation;
  std::vector<Delivery> deliveries;  ///< by rising time
  std::vector<TruePose> truth;       ///< by rising stamp: each hundredth of a second, and each message
  Time start{}, end{};

  /// The truth at a time, interpolated.
  TruePose truth_at(Time stamp) const;
};

/// Rates and phases of the sensors come from the scene's seed. Throws std::invalid_argument if the scene's
/// config has faults.
RecordedDrive record_drive(const AccuracyScene& scene);

}  // namespace relative_map::core
