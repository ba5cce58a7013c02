#include "relative_map/prediction/road_user.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

// A velocity shows where something drives to once it is this many of its own standard deviations.
constexpr double kSureSpeed = 3.0;
constexpr double kLeastSpeedForTheta = 0.5;  // [m/s]
// Votes that a type keeps at most: a second of another type at 10 Hz is then believed.
constexpr int kMaxTypeVotes = 10;
constexpr std::size_t kMaxHistory = 200;      // positions, whatever the rate
constexpr double kGivenVelocityStddev = 0.5;  // [m/s] of trackers that give one

/// Apollo's thresholds: slower is still [m/s].
double still_speed(RoadUserType type) {
  switch (type) {
    case RoadUserType::kVehicle:
      return 0.99;
    case RoadUserType::kPedestrian:
    case RoadUserType::kBicycle:
      return 0.2;
    default:
      return 0.5;
  }
}

}  // namespace

RoadUser::RoadUser(Time stamp, const SeenRoadUser& seen, double position_stddev,
                   const MotionFilterParam& param)
    : seen_(seen), stamp_(stamp), type_(seen.type), filter_(seen, position_stddev, param) {
  history_.push_back({stamp, seen.position});
  note_heading(seen);
  still_ = filter_.velocity().norm() < still_speed(type_);
}

void RoadUser::see(Time stamp, const SeenRoadUser& seen, double position_stddev,
                   const MotionFilterParam& param, double history_length) {
  filter_ = filter_at(stamp, param);
  filter_.update_position(seen.position, position_stddev);
  if (seen.velocity.allFinite()) filter_.update_velocity(seen.velocity, kGivenVelocityStddev);
  stamp_ = stamp;
  note_type(seen.type);
  const double heading = seen_.heading;
  seen_ = seen;
  if (!std::isfinite(seen_.heading)) seen_.heading = heading;
  history_.push_back({stamp, seen.position});
  while (history_.size() > kMaxHistory || to_seconds(stamp - history_.front().stamp) > history_length) {
    history_.pop_front();
  }
  note_heading(seen);
  still_ = speed() <
           std::max(still_speed(type_), 2.0 * filter_.speed_stddev({std::cos(theta_), std::sin(theta_)}));
}

double RoadUser::surprise(Time stamp, const SeenRoadUser& seen, double position_stddev,
                          const MotionFilterParam& param) const {
  return filter_at(stamp, param).surprise(seen.position, position_stddev);
}

double RoadUser::distance_to(Time stamp, const Point2& position) const {
  return (filter_.position() + to_seconds(stamp - stamp_) * filter_.velocity() - position).norm();
}

MotionFilter RoadUser::filter_at(Time now, const MotionFilterParam& param) const {
  MotionFilter filter = filter_;
  filter.predict(to_seconds(now - stamp_), theta_, acceleration_model(type_, param));
  return filter;
}

double RoadUser::history_span() const {
  return to_seconds(history_.back().stamp - history_.front().stamp);
}

void RoadUser::note_type(RoadUserType type) {
  if (type == type_) {
    type_votes_ = std::min(type_votes_ + 1, kMaxTypeVotes);
  } else if (type != RoadUserType::kUnknown && --type_votes_ <= 0) {
    type_ = type;
    type_votes_ = 1;
  }
}

void RoadUser::note_heading(const SeenRoadUser& seen) {
  const Point2 velocity = filter_.velocity();
  const double speed = velocity.norm();
  if (speed > kLeastSpeedForTheta && speed > kSureSpeed * filter_.speed_stddev(velocity / speed)) {
    theta_ = std::atan2(velocity.y(), velocity.x());
    theta_known_ = true;
    return;
  }
  if (!std::isfinite(seen.heading)) return;
  double heading = normalize_angle(seen.heading);
  // A detector can't tell front from back; the road user did not turn round within a frame.
  if (theta_known_ && std::abs(angle_difference(heading, theta_)) > kPi / 2.0) {
    heading = normalize_angle(heading + kPi);
  }
  theta_ = heading;
  theta_known_ = true;
}

}  // namespace relative_map::core
