#include "relative_map/pipeline/motion/input_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxSpeed = 100.0;  // [m/s]

// Of lane markers. No camera sees farther, no lane's paint lies farther aside, no road bends more.
constexpr double kFarthestSeen = 300.0;   // [m]
constexpr double kFarthestBehind = 50.0;  // [m]
constexpr double kFarthestAside = 10.0;   // [m] of the own lane's paint; others' lies anywhere
constexpr double kSteepest = 5.0;         // [-]
constexpr double kMaxBend = 0.5;          // [1/m] of c2
constexpr double kMaxBendRate = 0.1;      // [1/m^2] of c3
constexpr double kSurest = 1.001;         // a quality of 1, rounded
constexpr double kNarrowest = 1.0;        // [m] from paint to paint; mirrored paint is told as that
constexpr double kWidest = 10.0;          // [m] likewise

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// A marker that is seen with a number that no camera reports is not seen: its quality becomes 0.
void check_marker(const char* name, double farthest_aside, LaneMarker& marker,
                  std::vector<std::string>& remarks) {
  if (marker.quality == 0.0) return;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  struct Number {
    const char* field;
    double value, least, most;
  };
  const Number numbers[] = {
      {"quality", marker.quality, 0.0, kSurest},
      {"c0_position", marker.cubic.c0, -farthest_aside, farthest_aside},
      {"c1_heading_angle", marker.cubic.c1, -kSteepest, kSteepest},
      {"c2_curvature", marker.cubic.c2, -kMaxBend, kMaxBend},
      {"c3_curvature_derivative", marker.cubic.c3, -kMaxBendRate, kMaxBendRate},
      {"longitude_start", marker.longitude_start, -kInfinity, kFarthestSeen},
      {"view_range", marker.view_range, 0.0, kInfinity},
  };
  const auto prefix = [&](const Number& number) {
    return text("perception/lane_markers: ", name, ".", number.field, " is ", number.value);
  };
  for (const Number& number : numbers) {
    if (std::isfinite(number.value) && number.value >= number.least && number.value <= number.most) continue;
    remarks.push_back(prefix(number) + ": not used");
    marker.quality = 0.0;
    return;
  }
  marker.quality = std::min(marker.quality, 1.0);
  if (marker.view_range > kFarthestSeen) {
    remarks.push_back(prefix(numbers[6]) + text(" m: taken as ", kFarthestSeen, " m"));
    marker.view_range = kFarthestSeen;
  }
  if (marker.longitude_start < -kFarthestBehind) {
    remarks.push_back(prefix(numbers[5]) + text(" m: taken as ", -kFarthestBehind, " m"));
    marker.longitude_start = -kFarthestBehind;
  }
}

/// Two lines of paint with no lane between them: one of them may be right.
void note_width(Checked<LaneMarkers>& checked) {
  const LaneMarker &left = checked.input.left, &right = checked.input.right;
  if (left.quality == 0.0 || right.quality == 0.0) return;
  const double width = left.cubic.c0 - right.cubic.c0;
  if (std::abs(width) >= kNarrowest && width <= kWidest) return;
  checked.remarks.push_back(text("perception/lane_markers: c0_position of left_lane_marker is ",
                                 left.cubic.c0, " m and of right_lane_marker ", right.cubic.c0,
                                 " m, a lane of ", width, " m: each is used only where it is expected"));
}

}  // namespace

Checked<LaneMarkers> check_lane_markers(const LaneMarkers& markers) {
  Checked<LaneMarkers> checked{markers, {}, std::nullopt};
  LaneMarkers& input = checked.input;
  check_marker("left_lane_marker", kFarthestAside, input.left, checked.remarks);
  check_marker("right_lane_marker", kFarthestAside, input.right, checked.remarks);
  for (LaneMarker& marker : input.next_left) {
    check_marker("next_left_lane_marker", kFarthestSeen, marker, checked.remarks);
  }
  for (LaneMarker& marker : input.next_right) {
    check_marker("next_right_lane_marker", kFarthestSeen, marker, checked.remarks);
  }
  note_width(checked);
  return checked;
}

Checked<Chassis> check_chassis(const Chassis& chassis) {
  Checked<Chassis> checked{chassis, {}, std::nullopt};
  if (!std::isfinite(chassis.speed) || std::abs(chassis.speed) > kMaxSpeed) {
    checked.remarks.push_back(text("chassis: speed_mps is ", chassis.speed, ": ignored"));
    checked.input.speed = kNaN;
  }
  return checked;
}

}  // namespace relative_map::core
