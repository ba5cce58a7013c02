#include "relative_map/localization/planar/planar_filter.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

using namespace planar;

namespace {

constexpr double kMaxStep = 0.05;      // [s] of integration
constexpr double kLongestGap = 120.0;  // [s] without any measurement, after which it begins anew
constexpr double kFresh = 2.0;         // [s] that a fix is good to start from

double square(double x) {
  return x * x;
}

Eigen::Vector2d left_of(const Eigen::Vector2d& v) {
  return {-v.y(), v.x()};
}

Eigen::Vector2d turned(const Eigen::Vector2d& v, double angle) {
  return {std::cos(angle) * v.x() - std::sin(angle) * v.y(),
          std::sin(angle) * v.x() + std::cos(angle) * v.y()};
}

}  // namespace

PlanarFilter::PlanarFilter(const LocalizerParam& param) : param_(param) {
  gate_ = chi_square_gates(param.inertial.gate_probability);
}

PlanarState PlanarFilter::step(State state, const Event& event, const Event*) const {
  if (event.source == Sensor::kImu) return state;
  advance(state, event.stamp);
  state.of(event.source).last = event.stamp;
  if (state.running) {
    use(state, event);
  } else {
    align(state, event);
  }
  return state;
}

void PlanarFilter::advance(State& state, Time time) const {
  const double whole = state.has_time ? to_seconds(time - state.time) : 0.0;
  state.time = time;
  state.has_time = true;
  if (whole > kLongestGap) {
    state.running = false;
    state.memory.reset();
    return;
  }
  const int steps = std::max(1, static_cast<int>(std::ceil(whole / kMaxStep)));
  const double dt = whole / steps;
  if (!(dt > 0.0)) return;
  for (int i = 0; i < steps; ++i) {
    if (!state.running) {
      const double rate = std::isfinite(state.wheels.yaw_rate) ? state.wheels.yaw_rate : 0.0;
      const double yaw = state.path.z() + 0.5 * rate * dt;
      state.path +=
          dt * Eigen::Vector3d(state.wheels.speed * std::cos(yaw), state.wheels.speed * std::sin(yaw), rate);
      continue;
    }
    auto x = state.filter.state();
    const double yaw = x(kYaw) + 0.5 * x(kYawRate) * dt;
    const double c = std::cos(yaw), s = std::sin(yaw), way = x(kSpeed) * dt;
    Eigen::Matrix<double, kCount, kCount> f = Eigen::Matrix<double, kCount, kCount>::Identity();
    f(kX, kYaw) = -way * s;
    f(kX, kSpeed) = c * dt;
    f(kX, kYawRate) = -0.5 * way * s * dt;
    f(kY, kYaw) = way * c;
    f(kY, kSpeed) = s * dt;
    f(kY, kYawRate) = 0.5 * way * c * dt;
    f(kYaw, kYawRate) = dt;
    x(kX) += way * c;
    x(kY) += way * s;
    x(kYaw) = normalize_angle(x(kYaw) + x(kYawRate) * dt);
    Eigen::Matrix<double, kCount, kCount> q = Eigen::Matrix<double, kCount, kCount>::Zero();
    const double slip = square(param_.planar.slip) * dt * std::min(1.0, std::abs(x(kSpeed)));
    q(kX, kX) = slip * s * s;
    q(kY, kY) = slip * c * c;
    q(kX, kY) = q(kY, kX) = -slip * s * c;
    q(kSpeed, kSpeed) = square(param_.planar.acceleration) * dt;
    q(kYawRate, kYawRate) = square(param_.planar.yaw_acceleration) * dt;
    q(kRateBias, kRateBias) = square(2e-4) * dt;  // [rad/s] as it warms
    q(kScale, kScale) = square(1e-4) * dt;
    state.filter.predict_to(x, f, q);
    state.distance += std::abs(way);
  }
}

void PlanarFilter::align(State& state, const Event& event) const {
  if (const auto* wheels = std::get_if<WheelSpeed>(&event.data)) {
    state.wheels = *wheels;
    return;
  }
  auto memory =
      state.memory ? std::make_shared<PlanarMemory>(*state.memory) : std::make_shared<PlanarMemory>();
  const bool wheels = to_seconds(state.time - state.of(Sensor::kWheels).last) < 1.0;
  double yaw = kNotGiven, stddev = 0.15, speed = wheels ? state.wheels.speed : 0.0,
         speed_stddev = wheels ? 0.5 : 5.0;
  if (const auto* fix = std::get_if<PositionFix>(&event.data)) {
    if (!state.has_plane) {
      state.plane = TangentPlane(fix->place);
      state.has_plane = true;
    }
    const Eigen::Vector3d place = state.plane.to_plane(fix->place);
    const double noise = std::sqrt(std::max(fix->covariance(0, 0), fix->covariance(1, 1)));
    state.height = place.z();
    state.height_stddev = std::sqrt(fix->covariance(2, 2));
    memory->fix.emplace(event.stamp, *fix);
    if (wheels && std::isfinite(state.wheels.yaw_rate)) {
      memory->path.add(state.path.head<2>(), place.head<2>(), noise);
      if (const auto turn = memory->path.turn(); turn && turn->stddev < 0.1) {
        yaw = normalize_angle(state.path.z() + turn->angle);
        stddev = std::max(turn->stddev, 0.05);
      }
    }
    if (!memory->earlier_fix || to_seconds(event.stamp - memory->earlier_fix->first) > 10.0) {
      memory->earlier_fix.emplace(event.stamp, *fix);
    }
    const Eigen::Vector2d way = (place - state.plane.to_plane(memory->earlier_fix->second.place)).head<2>();
    const double seconds = to_seconds(event.stamp - memory->earlier_fix->first);
    // Nothing tells whether it turned on the way: only a fast one can't have turned far.
    if (!std::isfinite(yaw) && seconds > 0.0 && seconds < 6.0 && way.norm() > std::max(10.0, 14.0 * noise) &&
        way.norm() > 2.0 * param_.inertial.course_speed * seconds) {
      yaw = normalize_angle(std::atan2(way.y(), way.x()) + (wheels && speed < -0.3 ? kPi : 0.0));
      stddev = 0.3;
      if (!wheels) {
        speed = way.norm() / seconds;
        speed_stddev = 3.0;
      }
    }
  } else if (const auto* velocity = std::get_if<VelocityFix>(&event.data)) {
    const Eigen::Vector2d ground = velocity->velocity.head<2>();
    const double noise = std::sqrt(velocity->covariance(0, 0));
    if (ground.norm() >= param_.inertial.course_speed && noise < 0.1 * ground.norm()) {
      const bool backwards = wheels && state.wheels.speed < -0.3;
      yaw = normalize_angle(std::atan2(ground.y(), ground.x()) + (backwards ? kPi : 0.0));
      speed = backwards ? -ground.norm() : ground.norm();
      speed_stddev = 0.3;
    }
  } else if (const auto* heading = std::get_if<HeadingFix>(&event.data)) {
    yaw = heading->heading;
    stddev = std::max(heading->stddev, 0.01);
  }
  state.memory = memory;
  if (!std::isfinite(yaw) || !memory->fix || to_seconds(event.stamp - memory->fix->first) > kFresh) return;
  start(state, yaw, stddev, speed, speed_stddev);
}

void PlanarFilter::start(State& state, double yaw, double yaw_stddev, double speed,
                         double speed_stddev) const {
  const auto& [stamp, fix] = *state.memory->fix;
  const double age = to_seconds(state.time - stamp);
  const Eigen::Vector2d lever = param_.inertial.antenna.head<2>();
  const Eigen::Vector2d ahead(std::cos(yaw), std::sin(yaw));
  const Eigen::Vector2d place =
      state.plane.to_plane(fix.place).head<2>() + age * speed * ahead - turned(lever, yaw);
  KalmanFilter<kCount>::State x;
  x << place, yaw, speed, 0.0, 0.0, 1.0;
  KalmanFilter<kCount>::Covariance p = KalmanFilter<kCount>::Covariance::Zero();
  p.topLeftCorner<2, 2>() = fix.covariance.topLeftCorner<2, 2>() +
                            (square(age * speed_stddev) + 1e-4) * Eigen::Matrix2d::Identity();
  p(kYaw, kYaw) = square(yaw_stddev);
  p(kSpeed, kSpeed) = square(speed_stddev);
  p(kYawRate, kYawRate) = square(0.3);
  p(kRateBias, kRateBias) = square(param_.planar.yaw_rate_bias);
  p(kScale, kScale) = square(param_.inertial.wheel_scale_stddev);
  state.filter = KalmanFilter<kCount>(x, p);
  state.running = true;
  state.last_absolute = stamp;
  state.distance = 0.0;
  state.memory.reset();
  ++state.alignments;
}

void PlanarFilter::use(State& state, const Event& event) const {
  const auto& x = state.filter.state();
  switch (event.source) {
    case Sensor::kFix:
      return use_position(state, event, param_.inertial.antenna.head<2>());
    case Sensor::kMapPosition:
      return use_position(state, event, Eigen::Vector2d::Zero());
    case Sensor::kFixVelocity: {
      const VelocityFix& fix = std::get<VelocityFix>(event.data);
      const Eigen::Vector2d ahead(std::cos(x(kYaw)), std::sin(x(kYaw)));
      const Eigen::Vector2d around = turned(left_of(param_.inertial.antenna.head<2>()), x(kYaw));
      Eigen::Matrix<double, 2, kCount> h = Eigen::Matrix<double, 2, kCount>::Zero();
      h.col(kYaw) = x(kSpeed) * left_of(ahead) + x(kYawRate) * left_of(around);
      h.col(kSpeed) = ahead;
      h.col(kYawRate) = around;
      const Eigen::Vector2d innovation = fix.velocity.head<2>() - (x(kSpeed) * ahead + x(kYawRate) * around);
      update<2>(state, event.source, innovation, h, fix.covariance.topLeftCorner<2, 2>());
      return;
    }
    case Sensor::kHeading:
    case Sensor::kMapHeading: {
      const HeadingFix& fix = std::get<HeadingFix>(event.data);
      Eigen::Matrix<double, 1, kCount> h = Eigen::Matrix<double, 1, kCount>::Zero();
      h(kYaw) = 1.0;
      update<1>(state, event.source, Eigen::Matrix<double, 1, 1>(angle_difference(fix.heading, x(kYaw))), h,
                Eigen::Matrix<double, 1, 1>(square(fix.stddev)));
      return;
    }
    case Sensor::kWheels: {
      const WheelSpeed& wheels = std::get<WheelSpeed>(event.data);
      state.wheels = wheels;
      const double speed = wheels.sign_known ? wheels.speed : std::copysign(wheels.speed, x(kSpeed));
      Eigen::Matrix<double, 1, kCount> h = Eigen::Matrix<double, 1, kCount>::Zero();
      h(kSpeed) = x(kScale);
      h(kScale) = x(kSpeed);
      update<1>(
          state, event.source, Eigen::Matrix<double, 1, 1>(speed - x(kScale) * x(kSpeed)), h,
          Eigen::Matrix<double, 1, 1>(square(param_.inertial.wheel_speed_stddev) + square(0.01 * speed)));
      if (!std::isfinite(wheels.yaw_rate)) return;
      h.setZero();
      h(kYawRate) = 1.0;
      h(kRateBias) = 1.0;
      update<1>(state, event.source,
                Eigen::Matrix<double, 1, 1>(wheels.yaw_rate - x(kYawRate) - x(kRateBias)), h,
                Eigen::Matrix<double, 1, 1>(square(param_.planar.yaw_rate_stddev)));
      return;
    }
    case Sensor::kImu:
      return;
  }
}

void PlanarFilter::use_position(State& state, const Event& event, const Eigen::Vector2d& lever) const {
  const PositionFix& fix = std::get<PositionFix>(event.data);
  const auto& x = state.filter.state();
  const Eigen::Vector3d place = state.plane.to_plane(fix.place);
  const Eigen::Vector2d arm = turned(lever, x(kYaw));
  const Eigen::Vector2d innovation = place.head<2>() - (x.head<2>() + arm);
  Eigen::Matrix<double, 2, kCount> h = Eigen::Matrix<double, 2, kCount>::Zero();
  h.leftCols<2>().setIdentity();
  h.col(kYaw) = left_of(arm);
  SourceHealth& health = state.of(event.source);
  if (update<2>(state, event.source, innovation, h,
                correlation_factor(health, state.time, fix.fixed) * fix.covariance.topLeftCorner<2, 2>() +
                    1e-4 * Eigen::Matrix2d::Identity())) {
    note_used(health, state.time, std::sqrt(std::max(fix.covariance(0, 0), fix.covariance(1, 1))), fix.fixed);
    state.last_absolute = state.time;
    state.distance = 0.0;
    health.refused_in_row = 0;
    state.height = place.z();
    state.height_stddev = std::sqrt(fix.covariance(2, 2));
    if (state.filter.state().head<2>().norm() > 5000.0) {
      const Eigen::Vector2d here = state.filter.state().head<2>();
      const TangentPlane plane(state.plane.to_earth({here.x(), here.y(), state.height}));
      const Eigen::Matrix3d turn = plane.rotation_from(state.plane);
      state.filter.state().head<2>().setZero();
      state.filter.state()(kYaw) =
          normalize_angle(state.filter.state()(kYaw) + std::atan2(turn(1, 0), turn(0, 0)));
      state.plane = plane;
      state.height = 0.0;
    }
    return;
  }
  // Refused: five in a row over two seconds make the filter less certain, ten make it begin anew.
  if (health.refused_in_row == 0) health.first_refusal = state.time;
  ++health.refused_in_row;
  if (health.refused_in_row % 5 != 0 || to_seconds(state.time - health.first_refusal) < 2.0) return;
  state.steady_until = state.time + from_seconds(5.0);
  ++state.inflations;
  if (health.refused_in_row > 10) {
    state.running = false;
    state.path.setZero();
    health.refused_in_row = 0;
    return;
  }
  auto& p = state.filter.covariance();
  p(kX, kX) += square(innovation.x());
  p(kY, kY) += square(innovation.y());
  p(kYaw, kYaw) += square(0.2);
  p(kSpeed, kSpeed) += 1.0;
}

template <int Rows>
bool PlanarFilter::update(State& state, Sensor source, const Eigen::Matrix<double, Rows, 1>& innovation,
                          const Eigen::Matrix<double, Rows, kCount>& jacobian,
                          const Eigen::Matrix<double, Rows, Rows>& given) const {
  SourceHealth& health = state.of(source);
  const Eigen::Matrix<double, Rows, Rows> noise = health.noise_scale * given;
  auto expected = state.filter.expect(jacobian, noise);
  const double distance = expected.squared_distance(innovation);
  note_innovation(health, distance, Rows);
  if (!(distance < gate_[Rows])) {
    ++health.refused;
    return false;
  }
  ++health.accepted;
  if (const double weaker = huber_factor(distance, Rows); weaker > 1.0) {
    expected = state.filter.expect(jacobian, (weaker * noise).eval());
  }
  state.filter.correct(innovation, expected);
  state.filter.state()(kYaw) = normalize_angle(state.filter.state()(kYaw));
  return true;
}

}  // namespace relative_map::core
