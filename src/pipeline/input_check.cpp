#include "relative_map/pipeline/input_check.hpp"

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

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

/// Of unit length, or all zero where it gives no direction.
void normalize_orientation(Checked<Localization>& checked) {
  Eigen::Quaterniond& q = checked.input.map_from_body;
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm < 1e-6) {
    q.coeffs().setZero();
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
  if (!std::isfinite(input.heading)) {
    input.heading = kNaN;
    return;
  }
  if (!has_orientation) return;
  const double difference = angle_difference(input.heading, yaw_of(input.map_from_body));
  if (std::abs(difference) < kDirectionTolerance) return;
  if (input.heading == 0.0 && !is_identity(input.map_from_body)) {
    checked.remarks.push_back(
        "localization: pose.heading is 0 and disagrees with pose.orientation, which is used: "
        "set a heading that is not filled to NaN");
    input.heading = kNaN;
    return;
  }
  const double degrees = difference * 180.0 / kPi;
  if (is_identity(input.map_from_body)) {
    checked.remarks.push_back(text("localization: pose.orientation is the identity and disagrees by ",
                                   degrees, " degrees with pose.heading, which is used"));
  } else if (std::abs(std::abs(difference) - kPi / 2.0) < kDirectionTolerance) {
    checked.remarks.push_back(text("localization: pose.heading and pose.orientation disagree by ", degrees,
                                   " degrees, and the heading is used: orientation_convention is wrong"));
  } else {
    checked.refusal =
        Status{StatusCode::kInvalidLocalization,
               text("localization: pose.heading and pose.orientation disagree by ", degrees, " degrees")};
    return;
  }
  // Roll and pitch of a frame that is turned or not filled mean nothing here.
  input.map_from_body = Eigen::AngleAxisd(input.heading, Eigen::Vector3d::UnitZ());
}

void limit_motion(Checked<Localization>& checked) {
  Localization& input = checked.input;
  if (input.linear_velocity.isZero(0.0)) input.linear_velocity.setConstant(kNaN);  // never filled, or at rest
  const double speed = input.linear_velocity.head<2>().norm();
  if (speed > kMaxSpeed) {
    checked.remarks.push_back(text("localization: pose.linear_velocity is ", speed, " m/s: ignored"));
    input.linear_velocity.setConstant(kNaN);
  }
  if (std::abs(input.angular_velocity_body.z()) > kMaxYawRate) {
    checked.remarks.push_back(text("localization: pose.angular_velocity_vrf.z is ",
                                   input.angular_velocity_body.z(), " rad/s: ignored"));
    input.angular_velocity_body.setConstant(kNaN);
  }
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
  const auto check = [&](const char* name, LaneMarker& marker) {
    const std::pair<const char*, double> numbers[] = {{"quality", marker.quality},
                                                      {"c0_position", marker.cubic.c0},
                                                      {"c1_heading_angle", marker.cubic.c1},
                                                      {"c2_curvature", marker.cubic.c2},
                                                      {"c3_curvature_derivative", marker.cubic.c3},
                                                      {"longitude_start", marker.longitude_start},
                                                      {"view_range", marker.view_range}};
    for (const auto& [field, value] : numbers) {
      if (std::isfinite(value)) continue;
      checked.remarks.push_back(text("lane markers: ", name, ".", field, " is ", value, ": not used"));
      marker.quality = 0.0;
      return;
    }
  };
  check("left_lane_marker", checked.input.left);
  check("right_lane_marker", checked.input.right);
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
