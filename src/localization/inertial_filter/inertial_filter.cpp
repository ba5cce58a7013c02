#include "relative_map/localization/inertial_filter/inertial_filter.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kMaxStep = 0.025;                  // [s] of integration
constexpr double kNormalGap = 0.05;                 // [s] between samples, bridged in silence
constexpr double kLongestImuPeriod = 0.1;           // [s] a sensor that is slower than 10 Hz has gaps
constexpr double kLongestGap = 2.0;                 // [s] that is bridged at all
constexpr ImuNoise kGapNoise{0.15, 1.5, 0.0, 0.0};  // [1/sqrt(Hz)] what may have happened in a gap
constexpr double kSmoothing = 0.1;                  // [s] of the acceleration that stamps are carried by
constexpr int kStillBlocks = 10;                    // 1 s
constexpr double kReplane = 5000.0;                 // [m] from the plane's origin

ImuSample between(const ImuSample& a, const ImuSample& b, double weight) {
  return {a.angular_velocity + weight * (b.angular_velocity - a.angular_velocity),
          a.specific_force + weight * (b.specific_force - a.specific_force)};
}

}  // namespace

InertialFilter::InertialFilter(const InertialParam& param)
    : param_(param), antenna_(param.antenna - param.imu), axle_(-param.imu) {
  gate_ = chi_square_gates(param.gate_probability);
}

InertialState InertialFilter::step(State state, const Event& event, const Event* next_imu) const {
  advance(state, event, next_imu);
  if (event.source == Sensor::kImu) {
    const bool closed = state.window.add(event.stamp, state.sample);
    if (closed && state.mode == FilterMode::kRunning) use_vehicle(state);
    if (closed && state.mode == FilterMode::kAligning) find_level(state);
    return state;
  }
  state.of(event.source).last = std::max(state.of(event.source).last, event.stamp);
  if (state.mode == FilterMode::kRunning) {
    use(state, event);
  } else {
    align(state, event);
  }
  return state;
}

/// Carries the state to the event's time, with the sample between the last and the next.
void InertialFilter::advance(State& state, const Event& event, const Event* next_imu) const {
  const bool imu = event.source == Sensor::kImu;
  ImuSample sample = state.sample;
  Time next = event.stamp;  // the end of the stretch without samples that this lies in
  if (imu) {
    sample = std::get<ImuSample>(event.data);
  } else if (next_imu != nullptr && state.has_imu) {
    next = next_imu->stamp;
    const double whole = to_seconds(next - state.time), part = to_seconds(event.stamp - state.time);
    if (whole > 0.0) sample = between(state.sample, std::get<ImuSample>(next_imu->data), part / whole);
  }
  if (!state.has_imu) {
    if (state.mode == FilterMode::kWaiting || imu) {
      state.time = event.stamp;
      state.sample = sample;
      state.mode = FilterMode::kAligning;
    }
    state.time = event.stamp;
  } else {
    const double spacing = to_seconds(next - state.last_imu);
    const bool gap = spacing > std::max(kNormalGap, 2.5 * state.imu_period);
    if (spacing > kLongestGap) {
      // Nothing is known of how it turned: it is aligned again.
      if (state.mode == FilterMode::kRunning) {
        state.mode = FilterMode::kAligning;
        state.level = State::Level::kNone;
        state.memory.reset();
      }
      state.time = event.stamp;
      state.sample = sample;
    } else {
      move_to(state, event.stamp, sample, gap ? kGapNoise : param_.noise);
    }
    if (gap) state.gap_end = event.stamp;
  }
  if (imu) {
    if (state.has_imu) {
      const double spacing = std::min(to_seconds(event.stamp - state.last_imu), kLongestImuPeriod);
      state.imu_period += 0.05 * (spacing - state.imu_period);
    }
    state.last_imu = event.stamp;
    state.has_imu = true;
  }
}

void InertialFilter::move_to(State& state, Time time, const ImuSample& sample, const ImuNoise& noise) const {
  const double whole = to_seconds(time - state.time);
  const ImuSample from = state.sample;
  state.sample = sample;
  state.time = time;
  if (!(whole > 0.0)) return;
  const int steps = std::max(1, static_cast<int>(std::ceil(whole / kMaxStep)));
  const double dt = whole / steps;
  for (int i = 0; i < steps; ++i) {
    const ImuSample mean = between(from, sample, (i + 0.5) / steps);
    if (state.mode == FilterMode::kRunning) {
      predict_covariance(state.error.covariance(), state.nav, mean, noise, dt);
      const Eigen::Vector3d acceleration = move(state.nav, mean, state.earth, dt);
      const double weight = std::min(1.0, dt / kSmoothing);
      state.motion.acceleration += weight * (acceleration - state.motion.acceleration);
      state.distance += state.nav.velocity.head<2>().norm() * dt;
    } else if (state.level != State::Level::kNone) {
      state.nav.attitude =
          state.nav.attitude * rotation_by((mean.angular_velocity - state.nav.gyro_bias) * dt);
      const double fresh = to_seconds(state.time - state.of(Sensor::kWheels).last) < 0.5 ? 1.0 : 0.0;
      const double yaw = state.nav.yaw();
      state.path += fresh * state.wheel_speed * dt * Eigen::Vector2d(std::cos(yaw), std::sin(yaw));
    }
  }
  state.motion.rate = sample.angular_velocity - state.nav.gyro_bias;
}

/// What a vehicle on wheels can't do, ten times a second.
void InertialFilter::use_vehicle(State& state) const {
  state.earth = earth_effects(state.plane, state.nav.position);
  const double speed = state.nav.velocity.head<2>().norm();
  const double speed_stddev =
      std::sqrt(state.error.covariance().block<2, 2>(error::kVelocity, error::kVelocity).trace());
  const bool quiet = state.window.size() >= kStillBlocks &&
                     state.window.rate_span(kStillBlocks) < param_.still_rate &&
                     state.window.force_span(kStillBlocks) < param_.still_force;
  const bool wheels_roll =
      to_seconds(state.time - state.of(Sensor::kWheels).last) < 0.3 && std::abs(state.wheel_speed) > 0.05;
  // While fixes come, a fast vehicle is known to be one; without them its speed may be far out.
  const bool fixes = to_seconds(state.time - state.last_absolute) < 2.0;
  const double slow = fixes ? std::min(1.0, 3.0 * speed_stddev + 0.1) : 3.0 * speed_stddev + 0.1;
  state.standing =
      param_.zero_velocity && quiet && !wheels_roll && speed < slow && state.time >= state.steady_until;
  if (state.standing) {
    update(state, Sensor::kImu, observe_standing(state.nav, param_.zero_velocity_stddev), false);
    update(state, Sensor::kImu,
           observe_no_turning(state.nav, state.window.mean(1).angular_velocity, state.earth.rate,
                              param_.zero_rate_stddev),
           false);
  } else if (param_.nhc && speed > param_.nhc_min_speed) {
    const double turning = std::abs(state.motion.rate.z());
    update(state, Sensor::kImu,
           observe_rolling(state.nav, state.motion, axle_, param_.nhc_lateral + param_.nhc_yaw_rate * turning,
                           param_.nhc_vertical),
           false);
  }
}

void InertialFilter::use(State& state, const Event& event) const {
  const bool gnss = event.source == Sensor::kFix || event.source == Sensor::kFixVelocity;
  if (gnss && param_.gnss_only_init) return;
  const Eigen::Matrix3d local = state.plane.local_from_plane(state.nav.position);
  const auto of_plane = [&local](const Eigen::Matrix3d& covariance) {
    return Eigen::Matrix3d(local.transpose() * covariance * local);
  };
  switch (event.source) {
    case Sensor::kFix:
      return use_position(state, event, antenna_);
    case Sensor::kMapPosition:
      return use_position(state, event, axle_);
    case Sensor::kFixVelocity: {
      const VelocityFix& fix = std::get<VelocityFix>(event.data);
      const double clock = state.error.covariance()(error::kStampOffset, error::kStampOffset);
      update(state, event.source,
             observe_velocity(state.nav, state.motion, antenna_, local.transpose() * fix.velocity,
                              of_plane(fix.covariance) +
                                  clock * state.motion.acceleration * state.motion.acceleration.transpose()),
             true);
      return;
    }
    case Sensor::kHeading:
    case Sensor::kMapHeading: {
      const HeadingFix& fix = std::get<HeadingFix>(event.data);
      update(state, event.source, observe_heading(state.nav, fix.heading, fix.stddev), true);
      return;
    }
    case Sensor::kWheels:
      return use_wheels(state, std::get<WheelSpeed>(event.data));
    case Sensor::kImu:
      return;
  }
}

void InertialFilter::use_position(State& state, const Event& event, const Eigen::Vector3d& lever) const {
  const PositionFix& fix = std::get<PositionFix>(event.data);
  SourceHealth& health = state.of(event.source);
  health.distrust *= std::exp(-to_seconds(state.time - state.last_absolute) / 10.0);
  const Eigen::Matrix3d noise = correlation_factor(health, state.time, fix.fixed) * fix.covariance +
                                (health.distrust + 1e-4) * Eigen::Matrix3d::Identity();
  const Observation<3> seen =
      observe_position(state.nav, state.motion, lever, state.plane.to_plane(fix.place), noise);
  if (update(state, event.source, seen, true)) {
    note_used(health, state.time, std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1))), fix.fixed);
    state.last_absolute = state.time;
    state.distance = 0.0;
    if (state.nav.position.head<2>().norm() > kReplane) take_new_plane(state);
  } else {
    recover(state, event.source, seen.innovation);
  }
}

/// Wheels tell more often than their errors change: ten times a second is enough.
void InertialFilter::use_wheels(State& state, const WheelSpeed& wheels) const {
  const double predicted = axle_velocity(state.nav, state.motion, axle_).x();
  // Told the same to the last digit while the vehicle's own speed changes: it sticks.
  if (wheels.speed != state.wheel_speed) {
    state.wheel_changed = state.time;
    state.stuck_speed_change = predicted;
  }
  const bool sticks = wheels.speed != 0.0 && to_seconds(state.time - state.wheel_changed) > 1.0 &&
                      std::abs(predicted - state.stuck_speed_change) > 0.5;
  state.wheel_speed = wheels.speed;
  if (sticks || to_seconds(state.time - state.wheel_used) < 0.095) return;
  state.wheel_used = state.time;
  const double speed = wheels.sign_known ? wheels.speed : std::copysign(wheels.speed, predicted);
  const double stddev = std::hypot(param_.wheel_speed_stddev, 0.01 * speed);
  update(state, Sensor::kWheels, observe_wheel_speed(state.nav, state.motion, axle_, speed, stddev), true);
}

/// One correction, if it passes the gate. `robust`: an unlikely one counts less (Huber 1964, by its noise).
template <int Rows>
bool InertialFilter::update(State& state, Sensor source, const Observation<Rows>& seen, bool robust) const {
  SourceHealth& health = state.of(source);
  // Of the vehicle's own constraints only the two rows of rolling are in doubt.
  const bool adapts = source != Sensor::kImu || Rows == 2;
  const Eigen::Matrix<double, Rows, Rows> noise = (adapts ? health.noise_scale : 1.0) * seen.noise;
  auto expected = state.error.expect(seen.jacobian, noise);
  const double distance = expected.squared_distance(seen.innovation);
  // A vehicle that slips is no reason to doubt a fixed solution.
  const bool fixed = source == Sensor::kFix && seen.noise.trace() < 0.03;
  if (adapts) note_innovation(health, distance, Rows, fixed ? 9.0 : 400.0);
  if (!(distance < gate_[Rows])) {
    ++health.refused;
    return false;
  }
  ++health.accepted;
  health.refused_in_row = 0;
  const double weaker = robust ? huber_factor(distance, Rows) : 1.0;
  if (weaker > 1.0) expected = state.error.expect(seen.jacobian, (weaker * noise).eval());
  state.error.correct(seen.innovation, expected);
  inject(state.error.state(), state.nav, state.error.covariance());
  state.error.state().setZero();
  state.motion.rate = state.sample.angular_velocity - state.nav.gyro_bias;
  return true;
}

/// A source of positions was refused. If it goes on, and agrees with itself, the filter is what is wrong: it
/// is made less certain, and if that does not help, aligned again.
void InertialFilter::recover(State& state, Sensor source, const Eigen::Vector3d& innovation) const {
  constexpr int kInRow = 5;
  constexpr double kFor = 2.0;           // [s]
  constexpr double kOutage = 5.0;        // [s] after which it is the filter that has drifted
  constexpr double kMostInflations = 2;  // in a row
  SourceHealth& health = state.of(source);
  if (health.refused_in_row == 0) {
    health.first_refusal = state.time;
    health.refusals_agree = true;
  } else {
    const double changed = (innovation - health.refused_innovation).head<2>().norm();
    health.refusals_agree = health.refusals_agree && changed < 0.3 * innovation.head<2>().norm() + 1.0;
  }
  health.refused_innovation = innovation;
  ++health.refused_in_row;
  if (health.refused_in_row % kInRow != 0 || to_seconds(state.time - health.first_refusal) < kFor) return;
  if (!health.refusals_agree) {
    health.refusals_agree = true;  // perhaps the next ones do
    return;
  }
  state.steady_until = state.time + from_seconds(5.0);
  if (health.refused_in_row > kInRow * kMostInflations) {
    state.mode = FilterMode::kAligning;
    state.memory.reset();
    health.refused_in_row = 0;
    return;
  }
  const bool drifted = to_seconds(health.first_refusal - state.last_absolute) > kOutage;
  if (!drifted) health.distrust = std::max(health.distrust, innovation.head<2>().squaredNorm() / 9.0);
  ErrorCovariance& p = state.error.covariance();
  for (int i = 0; i < 3; ++i) {
    p(error::kPosition + i, error::kPosition + i) += innovation(i) * innovation(i);
    p(error::kVelocity + i, error::kVelocity + i) += 1.0;
  }
  const Eigen::Vector3d up = state.nav.attitude.transpose() * Eigen::Vector3d::UnitZ();
  p.block<3, 3>(error::kAttitude, error::kAttitude) += 0.01 * up * up.transpose();
  ++state.inflations;
}

void InertialFilter::take_new_plane(State& state) const {
  const GeoPoint here = state.plane.to_earth(state.nav.position);
  const TangentPlane plane(here);
  const Eigen::Matrix3d turn = plane.rotation_from(state.plane);
  state.plane = plane;
  state.nav.position.setZero();
  state.nav.velocity = turn * state.nav.velocity;
  state.nav.attitude = turn * state.nav.attitude;
  state.motion.acceleration = turn * state.motion.acceleration;
  ErrorCovariance& p = state.error.covariance();
  for (const int block : {error::kPosition, error::kVelocity}) {
    p.middleRows<3>(block) = (turn * p.middleRows<3>(block)).eval();
    p.middleCols<3>(block) = (p.middleCols<3>(block) * turn.transpose()).eval();
  }
  state.earth = earth_effects(state.plane, state.nav.position);
}

}  // namespace relative_map::core
