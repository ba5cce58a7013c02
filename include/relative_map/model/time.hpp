#pragma once

#include <chrono>
#include <cmath>
#include <sstream>
#include <string>

namespace relative_map::core {

/// A point in time: nanoseconds since the epoch, exact as ROS stamps are.
using Time = std::chrono::nanoseconds;

inline double to_seconds(Time duration) {
  return std::chrono::duration<double>(duration).count();
}
inline Time from_seconds(double seconds) {
  return Time(std::llround(seconds * 1e9));
}

/// As people are told of a duration: "1.23 s".
inline std::string seconds_text(Time duration) {
  std::ostringstream text;
  text.precision(3);
  text << to_seconds(duration) << " s";
  return text.str();
}

}  // namespace relative_map::core
