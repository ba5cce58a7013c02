#include "relative_map/localization/rtk/rtk_method.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/geometry/angles.hpp"
#include "relative_map/localization/geodesy/earth.hpp"

namespace relative_map::core {

namespace {

constexpr double kMemory = 2.0;       // [s] of messages
constexpr double kTogether = 0.12;    // [s] of a fix and the heading or velocity that go with it
constexpr double kCarried = 60.0;     // [s] that a heading is carried by the gyro
constexpr double kGyroDrift = 0.002;  // [rad/s] of its heading meanwhile, with the bias that a cheap one has
constexpr double kGround = 0.05;      // [rad] of slope and bank, which are not seen

}  // namespace

PoseEstimate compose_rtk(const RtkReading& reading, const Eigen::Vector3d& lever) {
  PoseEstimate estimate;
  estimate.position = reading.antenna;
  if (reading.rate) estimate.rate_body = *reading.rate;
  if (reading.acceleration) estimate.acceleration_body = *reading.acceleration;
  if (!reading.attitude) return estimate;
  const Eigen::Matrix3d attitude = reading.attitude->toRotationMatrix();
  estimate.map_from_body = *reading.attitude;
  estimate.heading = std::atan2(attitude(1, 0), attitude(0, 0));
  estimate.position -= attitude * lever;
  if (reading.rate) {
    estimate.velocity = reading.antenna_velocity - attitude * reading.rate->cross(lever);
  } else if (lever.isZero()) {
    estimate.velocity = reading.antenna_velocity;
  }
  return estimate;
}

Taken RtkMethod::add(const Event& event) {
  newest_ = any_ ? std::max(newest_, event.stamp) : event.stamp;
  any_ = true;
  if (event.source == Sensor::kImu) {
    if (!imu_.empty() && event.stamp > imu_.newest()) carry(event);
    imu_.add(event.stamp, std::get<ImuSample>(event.data));
    return Taken::kTaken;
  }
  SourceHealth& health = report_.health[static_cast<std::size_t>(event.source)];
  health.last = std::max(health.last, event.stamp);
  ++health.accepted;
  if (event.source == Sensor::kFix) {
    if (any_fix_ && event.stamp == last_fix_) return Taken::kTwice;
    if (any_fix_ && event.stamp < last_fix_) return Taken::kTooOld;
    any_fix_ = true;
    last_fix_ = event.stamp;
    waiting_.push_back(event);
    return Taken::kTaken;
  }
  const auto place = std::upper_bound(recent_.begin(), recent_.end(), event.stamp,
                                      [](Time stamp, const Event& other) { return stamp < other.stamp; });
  recent_.insert(place, event);
  while (to_seconds(recent_.back().stamp - recent_.front().stamp) > kMemory) recent_.pop_front();
  return Taken::kTaken;
}

/// Turns the course on by the gyro, while it is driven too slowly for another.
void RtkMethod::carry(const Event& imu) {
  if (!course_.known()) return;
  const double dt = to_seconds(imu.stamp - std::max(imu_.newest(), course_time_));
  const double age = to_seconds(imu.stamp - course_time_);
  if (to_seconds(imu.stamp - imu_.newest()) > param_.rtk.max_bracket || age > kCarried) {
    course_ = Heading();
    return;
  }
  if (dt <= 0.0) return;
  course_.yaw = normalize_angle(course_.yaw + std::get<ImuSample>(imu.data).angular_velocity.z() * dt);
  course_.stddev += kGyroDrift * dt;
}

const Event* RtkMethod::nearest(Sensor source, Time time, double within) const {
  const Event* best = nullptr;
  for (const Event& event : recent_) {
    if (event.source != source || std::abs(to_seconds(event.stamp - time)) > within) continue;
    if (!best || std::abs(to_seconds(event.stamp - time)) < std::abs(to_seconds(best->stamp - time)))
      best = &event;
  }
  return best;
}

RtkMethod::Heading RtkMethod::heading_at(Time time, const VelocityFix* velocity) {
  if (const Event* given = nearest(Sensor::kHeading, time, kTogether)) {
    const HeadingFix& fix = std::get<HeadingFix>(given->data);
    return {fix.heading, fix.stddev};
  }
  const double speed = velocity ? velocity->velocity.head<2>().norm() : 0.0;
  if (speed >= param_.rtk.course_speed) {
    const Event* wheels = nearest(Sensor::kWheels, time, 0.5);
    const bool backwards = wheels != nullptr && std::get<WheelSpeed>(wheels->data).speed < -0.1;
    course_.yaw =
        normalize_angle(std::atan2(velocity->velocity.y(), velocity->velocity.x()) + (backwards ? kPi : 0.0));
    course_.stddev = std::sqrt(velocity->covariance(0, 0)) / speed;
    course_time_ = time;
  }
  return course_;
}

std::optional<PoseEstimate> RtkMethod::estimate(const MapProjection& map) {
  if (waiting_.empty()) return std::nullopt;
  const Event fix = waiting_.front();
  const bool bracketed = !imu_.empty() && imu_.newest() >= fix.stamp;
  if (!bracketed && to_seconds(newest_ - fix.stamp) < param_.rtk.max_wait) return std::nullopt;
  waiting_.pop_front();
  return make(std::get<PositionFix>(fix.data), fix.stamp, map);
}

PoseEstimate RtkMethod::make(const PositionFix& fix, Time stamp, const MapProjection& map) {
  const MapPlace place = map.to_map(fix.place);
  const Event* moved = nearest(Sensor::kFixVelocity, stamp, kTogether);
  const VelocityFix* velocity = moved ? &std::get<VelocityFix>(moved->data) : nullptr;
  const Heading heading = heading_at(stamp, velocity);
  const ImuBuffer::Found imu = imu_.at(stamp, param_.rtk.max_bracket);
  RtkReading reading;
  reading.antenna = place.position;
  if (velocity) reading.antenna_velocity = place.map_from_local * velocity->velocity;
  Eigen::Matrix3d local_from_body = Eigen::Matrix3d::Identity();
  if (heading.known()) {
    local_from_body = Eigen::AngleAxisd(heading.yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    reading.attitude = Eigen::Quaterniond(place.map_from_local * local_from_body);
  }
  if (imu.sample) {
    reading.rate = imu.sample->angular_velocity;
    reading.acceleration =
        imu.sample->specific_force -
        Eigen::Vector3d(0.0, 0.0, normal_gravity(fix.place.latitude * kPi / 180.0, fix.place.altitude));
  }
  PoseEstimate estimate = compose_rtk(reading, param_.inertial.antenna);
  estimate.stamp = stamp;
  const double reach = param_.inertial.antenna.norm();
  const double turn = heading.known() ? std::hypot(heading.stddev, kGround) : 1.0;
  estimate.position_covariance = place.map_from_local * fix.covariance * place.map_from_local.transpose() +
                                 reach * reach * turn * turn * Eigen::Matrix3d::Identity();
  if (heading.known()) {
    estimate.attitude_covariance =
        Eigen::Vector3d(kGround * kGround, kGround * kGround, heading.stddev * heading.stddev).asDiagonal();
  }
  if (velocity) estimate.velocity_covariance = velocity->covariance;

  const double stddev = estimate.horizontal_stddev();
  estimate.code = fix.fixed && stddev <= param_.rtk.ok_stddev ? EstimateCode::kOk
                  : stddev <= param_.rtk.warning_stddev       ? EstimateCode::kWarning
                                                              : EstimateCode::kError;
  if (estimate.code != EstimateCode::kOk) {
    estimate.message =
        fix.fixed ? "the receiver is not sure of its place; " : "it is no fixed RTK solution; ";
  }
  if (!heading.known()) {
    estimate.code = EstimateCode::kError;
    estimate.message += "the heading is not known: no dual antenna's, and too slow for a course; ";
  }
  if (!imu.sample) {
    estimate.code = std::max(estimate.code, EstimateCode::kWarning);
    estimate.message += "no rates and accelerations: " + imu.why_not + "; ";
  }
  report_.aligned = heading.known();
  return estimate;
}

}  // namespace relative_map::core
