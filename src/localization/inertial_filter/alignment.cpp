// How the inertial filter finds level and heading; its other half is in inertial_filter.cpp.
#include <algorithm>
#include <cmath>

#include "relative_map/geometry/angles.hpp"
#include "relative_map/localization/inertial_filter/inertial_filter.hpp"

namespace relative_map::core {

namespace {

constexpr double kFresh = 2.0;         // [s] that a fix is good to start from
constexpr double kStraight = 0.1;      // [rad/s] turning slower is straight enough for a course
constexpr double kCourseStddev = 0.1;  // [rad] that a course must be known to
constexpr double kMatchStddev = 0.1;   // [rad] likewise by a path on fixes
constexpr double kRollingBias = 0.02;  // [rad/s] of a bias that was read while it rolled straight on
constexpr double kStraightWay = 0.1;   // [rad] between two ways that lead straight on

double square(double x) {
  return x * x;
}

Eigen::Matrix3d turned_about_up(double yaw) {
  return Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

/// Level attitude with the x axis at `yaw`, from a force that points up.
Eigen::Matrix3d level_attitude(const Eigen::Vector3d& up, double yaw) {
  const double roll = std::atan2(up.y(), up.z());
  const double pitch = std::atan2(-up.x(), std::hypot(up.y(), up.z()));
  return turned_about_up(yaw) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()).toRotationMatrix() *
         Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()).toRotationMatrix();
}

double largest_horizontal(const Eigen::Matrix3d& covariance) {
  return std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
}

}  // namespace

/// Without wheels and velocities: two ways in a row between fixes, that lead on in one direction. NaN: not
/// yet.
double InertialFilter::course_between_fixes(AlignmentMemory& memory, Time stamp, const PositionFix& fix,
                                            const TangentPlane& plane) const {
  const double noise = largest_horizontal(fix.covariance);
  if (!memory.earlier_fix) {
    memory.earlier_fix.emplace(stamp, fix);
    return kNotGiven;
  }
  const Eigen::Vector2d way =
      (plane.to_plane(fix.place) - plane.to_plane(memory.earlier_fix->second.place)).head<2>();
  const double seconds = to_seconds(stamp - memory.earlier_fix->first);
  if (way.norm() < std::max(5.0, 7.0 * noise)) {
    if (seconds > 10.0) memory.earlier_fix.emplace(stamp, fix);  // too slow to have gone straight for sure
    return kNotGiven;
  }
  const double course = std::atan2(way.y(), way.x());
  const bool straight =
      std::abs(angle_difference(course, memory.earlier_course)) < kStraightWay + noise / way.norm();
  const bool fast = way.norm() > param_.course_speed * seconds;
  memory.before_fix = memory.earlier_fix;
  memory.earlier_fix.emplace(stamp, fix);
  memory.earlier_course = course;
  return straight && fast ? course : kNotGiven;
}

/// Standing: from gravity, and the rate is the bias. Moving, after two seconds, from the mean force all the
/// same.
void InertialFilter::find_level(State& state) const {
  if (state.window.size() < StillnessWindow::kBlocks) return;
  const ImuSample mean = state.window.mean(StillnessWindow::kBlocks);
  const bool wheels_roll =
      to_seconds(state.time - state.of(Sensor::kWheels).last) < 0.3 && std::abs(state.wheel_speed) > 0.02;
  const bool moves = state.memory && state.memory->velocity &&
                     to_seconds(state.time - state.memory->velocity->first) < 1.5 &&
                     state.memory->velocity->second.velocity.head<2>().norm() > 0.3;
  const bool standing = !wheels_roll && !moves &&
                        state.window.rate_span(StillnessWindow::kBlocks) < param_.still_rate &&
                        state.window.force_span(StillnessWindow::kBlocks) < param_.still_force;
  if (!standing && state.level != State::Level::kNone) return;
  const double yaw = state.level == State::Level::kNone ? 0.0 : state.nav.yaw();
  state.nav.attitude = level_attitude(mean.specific_force, yaw);
  if (standing) state.nav.gyro_bias = mean.angular_velocity;
  state.level = standing ? State::Level::kStanding : State::Level::kMean;
}

void InertialFilter::align(State& state, const Event& event) const {
  if (const auto* wheels = std::get_if<WheelSpeed>(&event.data)) {
    state.wheel_speed = wheels->speed;
    return;
  }
  auto memory =
      state.memory ? std::make_shared<AlignmentMemory>(*state.memory) : std::make_shared<AlignmentMemory>();
  const bool level = state.level != State::Level::kNone;
  double yaw = kNotGiven, stddev = param_.yaw_stddev;
  bool matched = false;
  if (const auto* fix = std::get_if<PositionFix>(&event.data)) {
    if (!state.has_plane) {
      state.plane = TangentPlane(fix->place);
      state.has_plane = true;
    }
    memory->fix.emplace(event.stamp, *fix);
    state.last_absolute = event.stamp;
    const Eigen::Vector2d place = state.plane.to_plane(fix->place).head<2>();
    const double noise = largest_horizontal(fix->covariance);
    if (level) {
      memory->path.add(state.path, place, noise);
      if (const auto turn = memory->path.turn(); turn && turn->stddev < kMatchStddev) {
        yaw = normalize_angle(state.nav.yaw() + turn->angle);
        stddev = std::max(turn->stddev, 0.05);
        matched = true;
      }
      const bool wheels = to_seconds(event.stamp - state.of(Sensor::kWheels).last) < 1.0;
      if (!wheels && !std::isfinite(yaw)) yaw = course_between_fixes(*memory, event.stamp, *fix, state.plane);
    }
  } else if (const auto* velocity = std::get_if<VelocityFix>(&event.data)) {
    memory->velocity.emplace(event.stamp, *velocity);
    const Eigen::Vector2d ground = velocity->velocity.head<2>();
    const double speed = ground.norm();
    const bool straight = state.window.size() >= 5 && std::abs(state.window.mean(5).angular_velocity.z() -
                                                               state.nav.gyro_bias.z()) < kStraight;
    if (level && straight && speed >= param_.course_speed &&
        largest_horizontal(velocity->covariance) < kCourseStddev * speed) {
      const bool backwards =
          to_seconds(event.stamp - state.of(Sensor::kWheels).last) < 0.5 && state.wheel_speed < -0.3;
      yaw = normalize_angle(std::atan2(ground.y(), ground.x()) + (backwards ? kPi : 0.0));
    }
  } else if (const auto* heading = std::get_if<HeadingFix>(&event.data)) {
    if (level) {
      yaw = heading->heading;
      stddev = std::max(heading->stddev, 0.01);
    }
  }
  state.memory = memory;
  const bool straight = std::get_if<PositionFix>(&event.data) == nullptr || !matched;
  if (!std::isfinite(yaw) || !memory->fix) return;
  if (to_seconds(event.stamp - memory->fix->first) > kFresh) return;
  // Rolling straight on, what the gyro tells is its bias.
  if (straight && state.level == State::Level::kMean && state.window.size() >= 10) {
    state.nav.gyro_bias = state.window.mean(10).angular_velocity;
  }
  start(state, yaw, stddev);
}

void InertialFilter::start(State& state, double yaw, double yaw_stddev) const {
  const AlignmentMemory& memory = *state.memory;
  NavigationState& nav = state.nav;
  nav.attitude = turned_about_up(yaw - nav.yaw()) * nav.attitude;
  const bool standing = state.level == State::Level::kStanding;
  state.motion.rate = state.sample.angular_velocity - nav.gyro_bias;

  const PositionFix& fix = memory.fix->second;
  const double age = to_seconds(state.time - memory.fix->first);
  const Eigen::Matrix3d local = state.plane.local_from_plane(state.plane.to_plane(fix.place));
  double velocity_stddev = 1.0;
  const bool wheels = to_seconds(state.time - state.of(Sensor::kWheels).last) < 0.5;
  if (memory.velocity && to_seconds(state.time - memory.velocity->first) < 0.5) {
    nav.velocity = local.transpose() * memory.velocity->second.velocity;
    velocity_stddev = 0.3;
  } else if (wheels) {
    nav.velocity = nav.attitude * Eigen::Vector3d(state.wheel_speed, 0.0, 0.0);
    velocity_stddev = 0.3 + 0.15 * std::abs(state.wheel_speed);
  } else if (memory.before_fix && memory.before_fix->first < memory.fix->first) {
    const double seconds = to_seconds(memory.fix->first - memory.before_fix->first);
    nav.velocity =
        (state.plane.to_plane(fix.place) - state.plane.to_plane(memory.before_fix->second.place)) / seconds;
    nav.velocity.z() = 0.0;
    velocity_stddev = 2.0;
  } else {
    nav.velocity.setZero();
    velocity_stddev =
        standing && state.window.rate_span(StillnessWindow::kBlocks) < param_.still_rate ? 0.1 : 5.0;
  }
  nav.velocity -= nav.attitude * state.motion.rate.cross(antenna_);
  nav.position = state.plane.to_plane(fix.place) + age * nav.velocity - nav.attitude * antenna_;
  nav.accel_bias.setZero();
  // What was found before a second alignment stays: wheels, mount and clocks are the same.
  const bool first = state.alignments == 0;

  ErrorCovariance p = ErrorCovariance::Zero();
  p.block<3, 3>(error::kPosition, error::kPosition) =
      local.transpose() * fix.covariance * local +
      (square(age * velocity_stddev) + 1e-4) * Eigen::Matrix3d::Identity();
  const double tilt = param_.tilt_stddev * (standing ? 1.0 : 2.5);
  for (int i = 0; i < 3; ++i) {
    p(error::kVelocity + i, error::kVelocity + i) = square(velocity_stddev);
    p(error::kAttitude + i, error::kAttitude + i) = square(i == 2 ? yaw_stddev : tilt);
    p(error::kGyroBias + i, error::kGyroBias + i) = square(standing ? param_.gyro_bias_stddev : kRollingBias);
    p(error::kAccelBias + i, error::kAccelBias + i) = square(param_.accel_bias_stddev);
  }
  const ErrorCovariance& known = state.error.covariance();
  const double priors[] = {param_.wheel_scale_stddev, param_.mount_stddev, param_.mount_stddev,
                           param_.stamp_offset_stddev};
  for (int i = 0; i < 4; ++i) {
    const int at = error::kWheelScale + i;
    p(at, at) = first ? square(priors[i]) : std::max(known(at, at), square(0.2 * priors[i]));
  }
  // The fix was taken a little before or after its stamp, and the antenna moves on.
  const double clock = p(error::kStampOffset, error::kStampOffset);
  nav.position -= nav.stamp_offset * nav.velocity;
  p.block<3, 3>(error::kPosition, error::kPosition) += clock * nav.velocity * nav.velocity.transpose();
  p.block<3, 1>(error::kPosition, error::kStampOffset) = -clock * nav.velocity;
  p.block<1, 3>(error::kStampOffset, error::kPosition) = -clock * nav.velocity.transpose();

  state.error = ErrorFilter(ErrorState::Zero(), p);
  state.motion.acceleration.setZero();
  state.earth = earth_effects(state.plane, nav.position);
  state.mode = FilterMode::kRunning;
  state.last_absolute = memory.fix->first;
  state.distance = 0.0;
  state.memory.reset();
  ++state.alignments;
}

}  // namespace relative_map::core
