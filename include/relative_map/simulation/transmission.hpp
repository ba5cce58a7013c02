#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include "relative_map/model/time.hpp"

namespace relative_map::core {

/// How often a sensor measures, and how its messages arrive.
struct TransmissionParam {
  double min_rate = 50.0, max_rate = 100.0;     ///< [Hz] one rate a drive, from its seed
  double min_latency = 0.0, max_latency = 0.0;  ///< [s] from the measurement to its message; in order
  double lost = 0.0;                            ///< [0, 1] share of the messages that never arrive
  double repeated = 0.0;                        ///< [0, 1] share that arrive a second time, right after
  double late = 0.0;                            ///< [0, 1] share that arrive late, after newer ones ...
  double late_by = 0.0;                         ///< [s] ... by so much at most
};

/// The way of one sensor's messages.
class Transmission {
 public:
  Transmission(const TransmissionParam& param, std::uint64_t seed, std::uint32_t stream);

  /// When a message that was measured at `stamp` arrives: never, once or more often.
  std::vector<Time> arrivals(Time stamp);

 private:
  TransmissionParam param_;
  std::mt19937_64 engine_;
  Time last_{};  ///< no message in time overtakes another
};

/// One camera, one localization and one chassis.
struct SensorTransmission {
  TransmissionParam localization, chassis, markers{10.0, 15.0};
};

}  // namespace relative_map::core
