#pragma once

#include <chrono>
#include <cmath>
#include <sstream>
#include <string>

namespace relative_map::core {

/// How long: nanoseconds, exact as those of ROS are.
using Duration = std::chrono::nanoseconds;

/// The clock that the messages' stamps are of: the system's, or a simulation's. It can't be read here:
/// nothing in the core knows what time it is unless it is told.
struct StampClock {
  using duration = Duration;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<StampClock>;
  static constexpr bool is_steady = false;
};

/// When: a point in time, since the epoch. Two of them can be compared and subtracted, which gives a
/// Duration, but not added.
using Time = StampClock::time_point;

/// [s]
inline double to_seconds(Duration duration) {
  return std::chrono::duration<double>(duration).count();
}
inline Duration from_seconds(double seconds) {
  return Duration(std::llround(seconds * 1e9));
}
/// The time that is so many seconds [s] after the epoch.
inline Time at_seconds(double seconds) {
  return Time(from_seconds(seconds));
}
/// [s] of a time after the epoch.
inline double seconds_since_epoch(Time time) {
  return to_seconds(time.time_since_epoch());
}

/// As people are told of a duration: "1.23 s".
inline std::string seconds_text(Duration duration) {
  std::ostringstream text;
  text.precision(3);
  text << to_seconds(duration) << " s";
  return text.str();
}

}  // namespace relative_map::core
