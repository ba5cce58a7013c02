#include <algorithm>
#include <cmath>
#include <limits>

#include "doctor_rules.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/ros/map/map_engine.hpp"
#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map::doctor {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kLegLength = 2.0;                      // [m] well above the noise of positions
constexpr double kMinSpeed = 1.0;                       // [m/s] what is slower may be drift
constexpr double kMaxSpeed = 100.0;                     // [m/s] what is faster is a jump, not a motion
constexpr double kNeverZero = 5.0 * core::kPi / 180.0;  // [rad] farther from 0 than noise
constexpr double kQuarterTurn = core::kPi / 2.0;

/// [rad] As the core reads an orientation where no heading is given, which would win over it.
double yaw_of(const Eigen::Quaterniond& orientation) {
  core::Localization nothing_else;
  nothing_else.heading = kNaN;
  nothing_else.map_from_body = orientation;
  const auto state = core::make_vehicle_state(nothing_else, std::nullopt);
  const auto* vehicle = std::get_if<core::VehicleState>(&state);
  return vehicle ? vehicle->map_from_base.heading() : kNaN;
}

std::vector<PoseSample> make_poses(const Observations& seen) {
  std::vector<PoseSample> poses;
  if (seen.localization.messages.empty()) return poses;
  const ros::Time begin = seen.localization.messages.front().at;
  std::optional<core::Point2> origin;
  for (const auto& [at, message] : seen.localization.messages) {
    const core::Localization localization = to_core(*message, seen.config.orientation_convention, at);
    PoseSample pose;
    pose.time = core::to_seconds(localization.stamp - to_core(begin));
    const core::Point2 position = localization.position.head<2>();
    if (!origin && position.allFinite()) origin = position;
    pose.position = position - origin.value_or(core::Point2::Zero());
    pose.heading = localization.heading;
    pose.orientation = yaw_of(localization.map_from_body);
    pose.velocity = localization.linear_velocity.head<2>();
    pose.yaw_rate = localization.angular_velocity_body.z();
    poses.push_back(pose);
  }
  return poses;
}

std::vector<Leg> make_legs(const std::vector<PoseSample>& poses) {
  std::vector<Leg> legs;
  const PoseSample* start = nullptr;
  for (const PoseSample& pose : poses) {
    if (!pose.position.allFinite()) continue;
    if (!start || pose.time <= start->time) start = &pose;
    const core::Point2 moved = pose.position - start->position;
    if (moved.norm() < kLegLength) continue;
    Leg leg;
    leg.course = std::atan2(moved.y(), moved.x());
    leg.heading = core::interpolate_angle(start->heading, pose.heading, 0.5);
    leg.orientation = core::interpolate_angle(start->orientation, pose.orientation, 0.5);
    leg.distance = moved.norm();
    leg.duration = pose.time - start->time;
    leg.velocity = 0.5 * (start->velocity + pose.velocity);
    const double speed = leg.distance / leg.duration;
    if (speed > kMinSpeed && speed < kMaxSpeed) legs.push_back(leg);
    start = &pose;
  }
  return legs;
}

bool reversing_mostly(const Input<Chassis>& chassis) {
  const auto reverse = [](const Received<Chassis>& received) {
    return received.message->gear_location == Chassis::GEAR_REVERSE;
  };
  const auto count = std::count_if(chassis.messages.begin(), chassis.messages.end(), reverse);
  return 2 * static_cast<std::size_t>(count) > chassis.messages.size();
}

/// Whether an orientation contradicts a heading of 0; if by a quarter turn, it may be of the other
/// convention.
bool points_elsewhere(double orientation) {
  const double size = std::abs(orientation);
  return size > kNeverZero && std::abs(size - kQuarterTurn) > kNeverZero;
}

}  // namespace

std::string link_of(const std::string& frame_id, const std::string& base_frame) {
  return frame_id.empty() ? base_frame : frame_name(frame_id);
}

MeanDirection mean_direction(const std::vector<double>& angles) {
  core::Point2 sum = core::Point2::Zero();
  std::size_t count = 0;
  for (const double angle : angles) {
    if (!std::isfinite(angle)) continue;
    sum += core::Point2(std::cos(angle), std::sin(angle));
    ++count;
  }
  if (count == 0) return {kNaN, kNaN};
  const double mean = std::atan2(sum.y(), sum.x());
  double squares = 0.0;
  for (const double angle : angles) {
    if (std::isfinite(angle)) squares += std::pow(core::angle_difference(angle, mean), 2);
  }
  return {mean, std::sqrt(squares / static_cast<double>(count))};
}

double median(std::vector<double> values) {
  values.erase(std::remove_if(values.begin(), values.end(), [](double v) { return std::isnan(v); }),
               values.end());
  if (values.empty()) return kNaN;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

Evidence::Evidence(const Observations& observations)
    : seen(observations),
      poses(make_poses(seen)),
      legs(make_legs(poses)),
      reversing(reversing_mostly(seen.chassis)) {
  if (!seen.navigation.messages.empty()) {
    lines = MapEngine::prepare(*seen.navigation.messages.back().message, seen.config.pipeline);
  }
  const std::string& base_frame = seen.config.pipeline.base_frame;
  for (const auto& [at, message] : seen.localization.messages) {
    const auto checked = core::check_localization(to_core(*message, seen.config.orientation_convention, at));
    if (checked.refusal) {
      refused_poses.push_back(checked.refusal->message);
      continue;
    }
    const std::string link = link_of(message->child_frame_id, base_frame);
    const auto link_from_base = seen.transforms(link, base_frame, message->header.stamp);
    const bool carry = link_from_base && link != base_frame;
    const auto state = core::make_vehicle_state(
        carry ? core::carry_to_base(checked.input, *link_from_base) : checked.input, std::nullopt);
    if (const auto* status = std::get_if<core::Status>(&state)) {
      refused_poses.push_back(status->message);
    } else {
      vehicle = std::get<core::VehicleState>(state);
    }
  }
}

std::optional<double> Evidence::heading_not_in_radians() const {
  for (const PoseSample& pose : poses) {
    if (std::abs(pose.heading) > 2.0 * core::kPi + 0.01) return pose.heading;
  }
  return std::nullopt;
}

bool Evidence::heading_is_never_filled() const {
  const auto is_zero = [](const PoseSample& pose) { return pose.heading == 0.0; };
  if (poses.empty() || !std::all_of(poses.begin(), poses.end(), is_zero)) return false;
  if (!legs.empty()) {
    std::vector<double> ways;
    for (const Leg& leg : legs) ways.push_back(reversing ? leg.course + core::kPi : leg.course);
    const MeanDirection way = mean_direction(ways);
    return std::abs(way.mean) > kNeverZero || way.spread > kNeverZero;
  }
  return std::any_of(poses.begin(), poses.end(), [](const PoseSample& pose) {
    return std::isfinite(pose.orientation) && points_elsewhere(pose.orientation);
  });
}

}  // namespace relative_map::doctor
