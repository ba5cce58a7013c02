#include "relative_map/pipeline/motion/motion_inputs.hpp"

#include <cmath>
#include <limits>

#include "relative_map/model/remarks.hpp"

namespace relative_map::core {

namespace {

constexpr Duration kKeptBesideImages = std::chrono::seconds(1);  // of the way, beyond the oldest image

constexpr double kFarFromStart = 3.0;  // [m] farther than a vehicle at rest drifts

}  // namespace

MotionInputs::News MotionInputs::take(const Localization& link,
                                      const std::optional<Eigen::Isometry3d>& link_from_base,
                                      const MaxAgeParam& max_age, std::optional<Time> received) {
  News news;
  const StampOrder::Verdict order = localization_order_.judge(link.stamp, received, max_age.localization);
  if (!order.remark.empty()) news.remarks.push_back(order.remark);
  if (!order.take) {
    if (order.of_the_future) ahead_ = Ahead{*received, order.remark};
    news.dropped = true;
    return news;
  }
  if (order.went_back) {
    reset();
    localization_order_.judge(link.stamp, received, max_age.localization);
    news.time_went_back = true;
  }
  localization_ = check_numbers(link);
  doubt_zeros();
  look_at_direction(link, link_from_base, max_age);
  add_new(news.remarks, localization_->remarks);
  if (localization_->refusal) {
    add_new(news.remarks, {localization_->refusal->message});
    return news;
  }
  const bool by_orientation = std::isnan(localization_->input.heading);
  const bool turned = by_orientation_ && *by_orientation_ != by_orientation;
  by_orientation_ = by_orientation;
  if (link_from_base) localization_->input = carry_to_base(localization_->input, *link_from_base);
  const auto state = make_vehicle_state(localization_->input, fresh_chassis(link.stamp, max_age));
  if (const auto* status = std::get_if<Status>(&state)) {
    add_new(news.remarks, {status->message});
    return news;
  }
  if (turned) poses_.clear();  // they point elsewhere
  const bool trusted = poses_.trusts_odometry();
  const Duration kept = from_seconds(max_age.lane_markers) + kKeptBesideImages;
  poses_.keep(kept);
  dead_reckoning_.keep(kept);
  poses_.add(std::get<VehicleState>(state));
  dead_reckoning_.add(poses_.newest());
  news.odometry_failed = turned || (trusted && !poses_.trusts_odometry());
  news.moved = true;
  return news;
}

/// A speed that was never filled is 0, too.
void MotionInputs::doubt_zeros() {
  Localization& link = localization_->input;
  const Point2 place = link.position.head<2>();
  if (!start_ && place.allFinite()) start_ = place;
  came_away_ = came_away_ || (start_ && (place - *start_).norm() > kFarFromStart);
  velocity_filled_ = velocity_filled_ || !link.linear_velocity.isZero(0.0);
  if (came_away_ && !velocity_filled_) {
    link.linear_velocity.setConstant(std::numeric_limits<double>::quiet_NaN());
  }
}

/// What the witness is told besides the pose: what it is not told, it does without.
KnownMotion MotionInputs::known_motion(const MaxAgeParam& max_age) const {
  const Localization& link = localization_->input;
  const double yaw_rate = link.angular_velocity_body.z();
  KnownMotion known;
  known.speed = link.linear_velocity.head<2>().norm();
  known.yaw_rate = yaw_rate == 0.0 ? std::numeric_limits<double>::quiet_NaN() : yaw_rate;  // never filled
  if (const auto chassis = fresh_chassis(link.stamp, max_age); chassis && std::isfinite(chassis->speed)) {
    known.speed = std::abs(chassis->speed);
    if (chassis->sign_known && chassis->speed != 0.0) known.direction = chassis->speed < 0.0 ? -1 : 1;
  }
  if (!poses_.trusts_speed()) known.speed = std::numeric_limits<double>::quiet_NaN();
  return known;
}

void MotionInputs::look_at_direction(const Localization& link,
                                     const std::optional<Eigen::Isometry3d>& link_from_base,
                                     const MaxAgeParam& max_age) {
  const bool in_range = std::isnan(link.heading) == std::isnan(localization_->input.heading);
  if (!link.failure) witness_.add(localization_->input, link_from_base, known_motion(max_age), in_range);
  // What the witness has found is not acted on yet: it refuses maps of healthy drives after jumps.
  settle_direction(MotionEvidence{}, *localization_);
}

std::vector<std::string> MotionInputs::take(const Chassis& chassis, const MaxAgeParam& max_age,
                                            std::optional<Time> received) {
  const StampOrder::Verdict order = chassis_order_.judge(chassis.stamp, received, max_age.chassis);
  std::vector<std::string> remarks;
  if (!order.remark.empty()) remarks.push_back(order.remark);
  if (!order.take) return remarks;
  chassis_ = check_chassis(chassis);
  add_new(remarks, chassis_->remarks);
  return remarks;
}

std::optional<Time> MotionInputs::stamp() const {
  if (!localization_) return std::nullopt;
  return localization_->input.stamp;
}

std::optional<Chassis> MotionInputs::fresh_chassis(Time now, const MaxAgeParam& max_age) const {
  if (!chassis_) return std::nullopt;
  const double age = to_seconds(now - chassis_->input.stamp);
  if (std::abs(age) > max_age.chassis) return std::nullopt;
  return chassis_->input;
}

std::variant<VehicleState, Status> MotionInputs::vehicle(Time now, const MaxAgeParam& max_age,
                                                         std::vector<std::string>& remarks) const {
  const bool none = !localization_ || to_seconds(now - localization_->input.stamp) > max_age.localization;
  if (none && ahead_ && to_seconds(now - ahead_->received) <= max_age.localization) {
    return Status{StatusCode::kInvalidLocalization, ahead_->sentence};
  }
  if (!localization_) return Status{StatusCode::kNoLocalization, "no localization received yet"};
  const auto age = now - localization_->input.stamp;
  if (to_seconds(age) > max_age.localization) {
    return Status{StatusCode::kStaleLocalization, "the newest localization is " + seconds_text(age) + " old"};
  }
  if (to_seconds(-age) > max_age.localization) {
    return Status{StatusCode::kInvalidLocalization,
                  "localization: header.stamp is " + seconds_text(-age) + " in the future"};
  }
  if (localization_->refusal) return *localization_->refusal;
  add_new(remarks, localization_->remarks);
  const std::optional<Chassis> chassis = fresh_chassis(now, max_age);
  if (chassis) {
    add_new(remarks, chassis_->remarks);
    auto disagreement = speeds_disagree(localization_->input, *chassis);
    if (disagreement && poses_.trusts_speed()) add_new(remarks, {std::move(*disagreement)});
  }
  const bool by_chassis = chassis && std::isfinite(chassis->speed);
  add_new(remarks, poses_.remarks(by_chassis ? "chassis: speed_mps" : "localization: pose.linear_velocity"));
  auto state = make_vehicle_state(localization_->input, chassis);
  auto* vehicle = std::get_if<VehicleState>(&state);
  if (vehicle && !std::isfinite(vehicle->speed)) vehicle->speed = poses_.newest().speed;
  return state;
}

VehicleState MotionInputs::carried_to(Time now, VehicleState vehicle) const {
  if (!poses_.trusts_speed()) vehicle.speed = poses_.newest().speed;
  vehicle.yaw_rate = poses_.newest().yaw_rate;
  vehicle.map_from_base = carried_on(vehicle, to_seconds(now - vehicle.stamp));
  vehicle.stamp = now;
  return vehicle;
}

}  // namespace relative_map::core
