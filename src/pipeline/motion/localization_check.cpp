#include <cmath>
#include <limits>
#include <sstream>
#include <utility>

#include "relative_map/pipeline/motion/input_check.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegree = kPi / 180.0;
constexpr double kMaxSpeed = 100.0;               // [m/s]
constexpr double kMaxYawRate = 5.0;               // [rad/s]
constexpr double kNormTolerance = 0.1;            // of a quaternion
constexpr double kDirectionTolerance = 0.35;      // [rad] between heading and orientation
constexpr double kMaxHeading = 2.0 * kPi + 0.01;  // [rad] more is no angle in radians
constexpr double kToldOffset = 1.0 * kDegree;     // from the course

using Verdict = CourseCheck::Verdict;

template <class... Parts>
std::string text(const Parts&... parts) {
  std::ostringstream stream;
  (stream << ... << parts);
  return stream.str();
}

std::string degrees_text(double angle) {
  std::ostringstream stream;
  stream.precision(1);
  stream << std::fixed << std::abs(angle) / kDegree << " degrees";
  return stream.str();
}

/// Of unit length, or all zero where it gives no direction.
void normalize_orientation(Checked<Localization>& checked) {
  Eigen::Quaterniond& q = checked.input.map_from_body;
  const double norm = q.norm();
  if (!std::isfinite(norm) || norm < 1e-6) {
    const std::string numbers = text("(", q.x(), ", ", q.y(), ", ", q.z(), ", ", q.w(), ")");
    q.coeffs().setZero();
    if (!std::isfinite(checked.input.heading)) {
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

void limit_heading(Checked<Localization>& checked) {
  Localization& input = checked.input;
  if (std::isnan(input.heading) || std::abs(input.heading) <= kMaxHeading) return;
  const std::string what = text("localization: pose.heading is ", input.heading,
                                " rad, which is no angle in radians (is it in degrees?)");
  input.heading = kNaN;
  if (input.map_from_body.coeffs().isZero()) {
    checked.refusal = Status{StatusCode::kInvalidLocalization, what};
  } else {
    checked.remarks.push_back(what + ": ignored");
  }
}

void limit_motion(Checked<Localization>& checked) {
  Localization& input = checked.input;
  const double speed = input.linear_velocity.head<2>().norm();
  if (!(speed <= kMaxSpeed)) {
    checked.remarks.push_back(text("localization: pose.linear_velocity is ", speed, " m/s: ignored"));
    input.linear_velocity.setConstant(kNaN);
  }
  if (!(std::abs(input.angular_velocity_body.z()) <= kMaxYawRate)) {
    checked.remarks.push_back(text("localization: pose.angular_velocity_vrf.z is ",
                                   input.angular_velocity_body.z(), " rad/s: ignored"));
    input.angular_velocity_body.setConstant(kNaN);
  }
}

bool is_identity(const Eigen::Quaterniond& q) {
  return q.vec().isZero();
}

double yaw_of(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d forward = q * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

enum class Direction { kHeading, kOrientation, kNeither };

/// Of two that are both given.
Direction choose(const MotionEvidence& motion, Checked<Localization>& checked) {
  const double heading = checked.input.heading, yaw = yaw_of(checked.input.map_from_body);
  const Verdict of_heading = motion.heading.verdict, of_orientation = motion.orientation.verdict;
  const double difference = angle_difference(heading, yaw);
  const std::string both = text("localization: pose.heading (", heading, " rad) and pose.orientation (yaw ",
                                yaw, " rad) disagree by ", difference / kDegree, " degrees");
  const bool agree = std::abs(difference) < kDirectionTolerance;
  const auto borne_out = [&](const char* which, const char* other, CourseCheck::Cause cause,
                             bool orientation) {
    if (agree) return;
    std::string why = cause == CourseCheck::Cause::kNone
                          ? ""
                          : text("; of ", other, ": ", likely_cause(cause, orientation));
    checked.remarks.push_back(text(both, ", and the ", which, " is used: the motion bears it out", why));
  };
  const bool heading_fails = agree ? of_heading == Verdict::kContradicted : of_heading != Verdict::kBorneOut;
  if (heading_fails && of_orientation == Verdict::kBorneOut) {
    borne_out("orientation", "pose.heading", motion.heading.cause, false);
    return Direction::kOrientation;
  }
  if (agree) return Direction::kHeading;
  if (of_heading == Verdict::kBorneOut && of_orientation != Verdict::kBorneOut) {
    borne_out("heading", "pose.orientation", motion.orientation.cause, true);
    return Direction::kHeading;
  }
  if (heading == 0.0) {
    checked.remarks.push_back(
        "localization: pose.heading is 0 and disagrees with pose.orientation, which is used: "
        "set a heading that is not filled to NaN");
    return Direction::kOrientation;
  }
  if (is_identity(checked.input.map_from_body)) {
    checked.remarks.push_back(both + ", and the heading is used: pose.orientation is the identity");
    return Direction::kHeading;
  }
  const bool quarter = std::abs(std::abs(difference) - kPi / 2.0) < kDirectionTolerance;
  if (quarter && of_orientation != Verdict::kBorneOut) {
    checked.remarks.push_back(both + ", and the heading is used: orientation_convention is wrong");
    return Direction::kHeading;
  }
  checked.refusal = Status{StatusCode::kInvalidLocalization, both};
  return Direction::kNeither;
}

}  // namespace

Checked<Localization> check_numbers(const Localization& link) {
  Checked<Localization> checked{link, {}, std::nullopt};
  if (link.failure) {
    checked.refusal = Status{StatusCode::kInvalidLocalization,
                             "localization: it says itself that it has failed (status ERROR)" +
                                 (link.failure->empty() ? "" : ": " + *link.failure)};
  }
  normalize_orientation(checked);
  limit_heading(checked);
  limit_motion(checked);
  return checked;
}

void settle_direction(const MotionEvidence& motion, Checked<Localization>& checked) {
  if (checked.refusal) return;
  Localization& input = checked.input;
  const bool has_heading = std::isfinite(input.heading),
             has_orientation = !input.map_from_body.coeffs().isZero();
  // Only once the vehicle has driven against it: who drives to the east has the identity.
  if (!has_heading && is_identity(input.map_from_body) &&
      motion.orientation.verdict == Verdict::kContradicted) {
    checked.refusal =
        Status{StatusCode::kInvalidLocalization,
               "localization: pose.heading is not given, and pose.orientation is the identity, as "
               "if it was never filled: neither gives a direction"};
    return;
  }
  const Direction direction = has_heading && has_orientation ? choose(motion, checked)
                              : has_heading                  ? Direction::kHeading
                                                             : Direction::kOrientation;
  if (direction == Direction::kNeither) return;
  const bool by_heading = direction == Direction::kHeading;
  const DirectionEvidence& evidence = by_heading ? motion.heading : motion.orientation;
  const std::string field = by_heading ? "localization: pose.heading" : "localization: pose.orientation";
  if (evidence.verdict == Verdict::kContradicted) {
    checked.refusal =
        Status{StatusCode::kInvalidLocalization,
               text(field, " is ", degrees_text(evidence.latest_offset),
                    " off from where the vehicle drives: ", likely_cause(evidence.cause, !by_heading))};
    return;
  }
  const double offset = evidence.steady_offset;
  if (std::abs(offset) > kToldOffset) {
    checked.remarks.push_back(text(field, " is ", degrees_text(offset), " to the ",
                                   offset > 0.0 ? "left" : "right",
                                   " of where the vehicle drives: corrected by that"));
  }
  const double given = by_heading ? input.heading : yaw_of(input.map_from_body);
  const double yaw = has_orientation ? yaw_of(input.map_from_body) : given;
  input.heading = by_heading ? normalize_angle(given - offset) : kNaN;
  if (!has_orientation || (offset == 0.0 && std::abs(angle_difference(given, yaw)) < kDirectionTolerance))
    return;
  // Roll and pitch of a frame that is turned or not filled mean nothing here.
  const bool upright = std::abs(angle_difference(given, yaw)) < kDirectionTolerance;
  const Eigen::AngleAxisd turn(upright ? given - offset - yaw : given - offset, Eigen::Vector3d::UnitZ());
  input.map_from_body = upright ? turn * input.map_from_body : Eigen::Quaterniond(turn);
}

Checked<Localization> check_localization(const Localization& link) {
  Checked<Localization> checked = check_numbers(link);
  settle_direction({}, checked);
  return checked;
}

}  // namespace relative_map::core
