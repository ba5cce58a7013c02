#include "relative_map/pipeline/motion/input_check.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxSpeed = 100.0;           // [m/s]
constexpr double kMaxYawRate = 5.0;           // [rad/s]
constexpr double kNormTolerance = 0.1;        // of a quaternion
constexpr double kDirectionTolerance = 0.35;  // [rad] between heading and orientation
constexpr double kMaxHeading = 1e6;           // [rad] an angle of more has no digits left for the direction

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

/// Not if it is NaN, either.
bool is_angle(double heading) {
  return std::abs(heading) < kMaxHeading;
}

/// Of unit length, or all zero where it gives no direction.
void normalize_orientation(Checked<Localization>& checked) {
  Eigen::Quaterniond& q = checked.input.map_from_body;
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm < 1e-6) {
    const std::string numbers = text("(", q.x(), ", ", q.y(), ", ", q.z(), ", ", q.w(), ")");
    q.coeffs().setZero();
    if (!is_angle(checked.input.heading)) {
      checked.refusal =
          Status{StatusCode::kInvalidLocalization,
                 text("localization: pose.heading is ", checked.input.heading,
                      ", and pose.orientation (x, y, z, w) is ", numbers, ": neither gives a direction")};
    } else {
      checked.remarks.push_back(
          text("localization: pose.orientation (x, y, z, w) is ", numbers, ": ignored"));
    }
    return;
  }
  if (std::abs(norm - 1.0) > kNormTolerance) {
    checked.remarks.push_back(text("localization: pose.orientation has norm ", norm, ": normalised"));
  }
  q.normalize();
}

bool is_identity(const Eigen::Quaterniond& q) {
  return q.vec().isZero();
}

double yaw_of(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d forward = q * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

/// Settles which of heading and orientation holds.
void settle_direction(Checked<Localization>& checked) {
  Localization& input = checked.input;
  const bool has_orientation = !input.map_from_body.coeffs().isZero();
  if (!is_angle(input.heading)) {
    if (!std::isnan(input.heading)) {
      checked.remarks.push_back(text("localization: pose.heading is ", input.heading, " rad: ignored"));
    }
    input.heading = kNaN;
    return;
  }
  if (!has_orientation) return;
  const double yaw = yaw_of(input.map_from_body);
  const double difference = angle_difference(input.heading, yaw);
  if (std::abs(difference) < kDirectionTolerance) return;
  if (input.heading == 0.0) {
    checked.remarks.push_back(
        "localization: pose.heading is 0 and disagrees with pose.orientation, which is used: "
        "set a heading that is not filled to NaN");
    input.heading = kNaN;
    return;
  }
  const std::string both =
      text("localization: pose.heading (", input.heading, " rad) and pose.orientation (yaw ", yaw,
           " rad) disagree by ", difference * 180.0 / kPi, " degrees");
  if (is_identity(input.map_from_body)) {
    checked.remarks.push_back(both + ", and the heading is used: pose.orientation is the identity");
  } else if (std::abs(std::abs(difference) - kPi / 2.0) < kDirectionTolerance) {
    checked.remarks.push_back(both + ", and the heading is used: orientation_convention is wrong");
  } else {
    checked.refusal = Status{StatusCode::kInvalidLocalization, both};
    return;
  }
  // Roll and pitch of a frame that is turned or not filled mean nothing here.
  input.map_from_body = Eigen::AngleAxisd(input.heading, Eigen::Vector3d::UnitZ());
}

void limit_motion(Checked<Localization>& checked) {
  Localization& input = checked.input;
  const double speed = input.linear_velocity.head<2>().norm();
  if (input.linear_velocity.isZero(0.0)) {  // never filled, or at rest
    input.linear_velocity.setConstant(kNaN);
  } else if (!(speed <= kMaxSpeed)) {
    checked.remarks.push_back(text("localization: pose.linear_velocity is ", speed, " m/s: ignored"));
    input.linear_velocity.setConstant(kNaN);
  }
  if (!(std::abs(input.angular_velocity_body.z()) <= kMaxYawRate)) {
    checked.remarks.push_back(text("localization: pose.angular_velocity_vrf.z is ",
                                   input.angular_velocity_body.z(), " rad/s: ignored"));
    input.angular_velocity_body.setConstant(kNaN);
  }
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

Checked<Localization> check_localization(const Localization& link) {
  Checked<Localization> checked{link, {}, std::nullopt};
  normalize_orientation(checked);
  settle_direction(checked);
  limit_motion(checked);
  return checked;
}

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
