#include "relative_map/pipeline/motion/motion_inputs.hpp"

#include <cmath>

#include "relative_map/model/remarks.hpp"

namespace relative_map::core {

namespace {

constexpr Duration kLate =
    std::chrono::milliseconds(500);  // an older message than the newest, but of the same time

}  // namespace

MotionInputs::News MotionInputs::take(const Localization& link,
                                      const std::optional<Eigen::Isometry3d>& link_from_base,
                                      const MaxAgeParam& max_age) {
  News news;
  if (localization_ && link.stamp < localization_->input.stamp) {
    if (localization_->input.stamp - link.stamp < kLate) {
      news.late = true;
      return news;
    }
    reset();
    news.time_went_back = true;
  }
  localization_ = check_localization(link);
  news.remarks = localization_->remarks;
  if (localization_->refusal) {
    add_new(news.remarks, {localization_->refusal->message});
    return news;
  }
  if (link_from_base) localization_->input = carry_to_base(localization_->input, *link_from_base);
  const auto state = make_vehicle_state(localization_->input, fresh_chassis(link.stamp, max_age));
  if (const auto* status = std::get_if<Status>(&state)) {
    add_new(news.remarks, {status->message});
    return news;
  }
  const bool trusted = poses_.trusts_odometry();
  poses_.add(std::get<VehicleState>(state));
  news.odometry_failed = trusted && !poses_.trusts_odometry();
  news.moved = true;
  return news;
}

std::vector<std::string> MotionInputs::take(const Chassis& chassis) {
  chassis_ = check_chassis(chassis);
  return chassis_->remarks;
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
