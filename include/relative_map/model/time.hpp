#pragma once

#include <chrono>
#include <cmath>

namespace relative_map::core {

/// A point in time: nanoseconds since the epoch, exact as ROS stamps are.
using Time = std::chrono::nanoseconds;

inline double to_seconds(Time duration) {
  return std::chrono::duration<double>(duration).count();
}
inline Time from_seconds(double seconds) {
  return Time(std::llround(seconds * 1e9));
}

}  // namespace relative_map::core
