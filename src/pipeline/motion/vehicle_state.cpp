#include "relative_map/pipeline/motion/vehicle_state.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kJump = 5.0;            // [m] that no speed has to explain
constexpr double kFastest = 60.0;        // [m/s] of a vehicle whose speed is not known
constexpr double kSpeedTolerance = 3.0;  // [m/s] between chassis and localization ...
constexpr double kSpeedShare = 0.1;      // ... and of the speed, besides

bool usable(const Eigen::Quaterniond& q) {
  return q.coeffs().allFinite() && q.norm() > 1e-6;
}

/// No projection of the Earth reaches farther.
bool is_coordinate(double value) {
  return std::isfinite(value) && std::abs(value) < 1e8;
}

double yaw_of(const Eigen::Quaterniond& q) {
  const Eigen::Vector3d forward = q.normalized() * Eigen::Vector3d::UnitX();
  return std::atan2(forward.y(), forward.x());
}

/// Counter-clockwise from east; NaN where neither heading nor orientation gives it.
double heading_of(const Localization& localization) {
  if (std::isfinite(localization.heading)) return normalize_angle(localization.heading);
  return usable(localization.map_from_body) ? yaw_of(localization.map_from_body)
                                            : std::numeric_limits<double>::quiet_NaN();
}

/// Roll and pitch from the orientation, yaw from the heading, which is the better one where both are given.
Eigen::Quaterniond attitude_of(const Localization& localization) {
  const double heading = heading_of(localization);
  if (!usable(localization.map_from_body)) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(heading, Eigen::Vector3d::UnitZ()));
  }
  const Eigen::Quaterniond q = localization.map_from_body.normalized();
  return Eigen::AngleAxisd(heading - yaw_of(q), Eigen::Vector3d::UnitZ()) * q;
}

Status invalid(const std::string& field, double value) {
  std::ostringstream sentence;
  sentence << "localization: " << field << " is " << value;
  return {StatusCode::kInvalidLocalization, sentence.str()};
}

}  // namespace

Localization carry_to_base(const Localization& link, const Eigen::Isometry3d& link_from_base) {
  Localization base = link;
  const Eigen::Quaterniond map_from_link = attitude_of(link);
  const Eigen::Vector3d arm = map_from_link * link_from_base.translation();
  const Eigen::Quaterniond link_from_base_rotation(link_from_base.rotation());
  base.position = link.position + arm;
  base.map_from_body = map_from_link * link_from_base_rotation;
  base.heading = yaw_of(base.map_from_body);
  base.angular_velocity_body = link_from_base_rotation.inverse() * link.angular_velocity_body;
  const Eigen::Vector3d omega = map_from_link * link.angular_velocity_body;
  if (omega.allFinite()) base.linear_velocity = link.linear_velocity + omega.cross(arm);
  return base;
}

std::variant<VehicleState, Status> make_vehicle_state(const Localization& base,
                                                      const std::optional<Chassis>& chassis) {
  const double heading = heading_of(base);
  if (!std::isfinite(heading)) {
    return Status{StatusCode::kInvalidLocalization,
                  "localization: neither pose.heading nor pose.orientation gives a direction"};
  }
  if (!is_coordinate(base.position.x())) return invalid("pose.position.x", base.position.x());
  if (!is_coordinate(base.position.y())) return invalid("pose.position.y", base.position.y());
  VehicleState state;
  state.stamp = base.stamp;
  state.map_from_base = Pose2(base.position.head<2>(), heading);
  const double along = base.linear_velocity.head<2>().dot(state.map_from_base.forward());
  state.speed = chassis && std::isfinite(chassis->speed) ? chassis->speed : along;
  state.yaw_rate = base.angular_velocity_body.z();
  state.position_stddev = base.position_stddev;
  state.heading_stddev = base.heading_stddev;
  return state;
}

std::optional<std::string> speeds_disagree(const Localization& base, const Chassis& chassis) {
  const double along = base.linear_velocity.head<2>().dot(Pose2(Point2::Zero(), heading_of(base)).forward());
  const double difference = std::abs(chassis.speed - along);
  if (!(difference > kSpeedTolerance + kSpeedShare * std::abs(along))) return std::nullopt;
  std::ostringstream sentence;
  sentence.precision(3);
  sentence << "chassis: speed_mps is " << chassis.speed
           << " m/s by its gear, but localization: pose.linear_velocity is " << along
           << " m/s along the heading: the chassis is believed";
  return sentence.str();
}

bool has_jumped(const VehicleState& before, const VehicleState& after) {
  const double moved = (after.map_from_base.position() - before.map_from_base.position()).norm();
  const double seconds = std::abs(to_seconds(after.stamp - before.stamp));
  const double fastest = std::isfinite(before.speed) && std::isfinite(after.speed)
                             ? std::max(std::abs(before.speed), std::abs(after.speed))
                             : kFastest;
  return !(moved <= kJump + 1.5 * seconds * fastest);  // NaN is no place that can be driven to
}

Pose2 carried_on(const VehicleState& state, double seconds) {
  const double turn = state.yaw_rate * seconds;
  const double half = 0.5 * turn;
  const double chord = state.speed * seconds * (std::abs(half) > 1e-6 ? std::sin(half) / half : 1.0);
  return state.map_from_base.to_parent(Pose2(chord * Point2(std::cos(half), std::sin(half)), turn));
}

}  // namespace relative_map::core
