#include "relative_map/simulation/sensors/sensor_suite.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace relative_map::core {

namespace {

// Streams of random numbers: each sensor has its own, and no two of the simulation share one.
constexpr std::uint32_t kImuStream = 41, kReceiverStream = 42, kWheelStream = 43, kSlowStream = 44,
                        kMultipathStream = 47;
constexpr double kVerticalFactor = 2.0;  // heights are worse by that, as all satellites are above

Eigen::Vector3d draw(NoiseSource& noise, double stddev) {
  const double x = noise.draw(stddev), y = noise.draw(stddev), z = noise.draw(stddev);
  return {x, y, z};
}

Eigen::Vector3d at(std::vector<OrnsteinUhlenbeck>& axes, double time) {
  return {axes[0].at(time), axes[1].at(time), kVerticalFactor * axes[2].at(time)};
}

const SensorParam& checked(const SensorParam& param) {
  std::string text;
  for (const std::string& fault : param.validate()) text += (text.empty() ? "" : "; ") + fault;
  if (!text.empty()) throw std::invalid_argument(text);
  return param;
}

}  // namespace

SimulatedImuSensor::SimulatedImuSensor(const SimulatedImuParam& param, std::uint64_t seed)
    : param_(param),
      noise_(seed, kImuStream),
      sensor_from_body_((Eigen::AngleAxisd(param.yaw, Eigen::Vector3d::UnitZ()) *
                         Eigen::AngleAxisd(param.pitch, Eigen::Vector3d::UnitY()) *
                         Eigen::AngleAxisd(param.roll, Eigen::Vector3d::UnitX()))
                            .toRotationMatrix()
                            .transpose()) {
  gyro_bias_ = draw(noise_, param_.gyro_bias);
  accel_bias_ = draw(noise_, param_.accel_bias);
}

SimulatedReading SimulatedImuSensor::measure(const BodyMotion& motion) {
  const double root = std::sqrt(motion.step());
  gyro_bias_ += draw(noise_, param_.gyro_bias_walk * root);
  accel_bias_ += draw(noise_, param_.accel_bias_walk * root);
  SimulatedImu sample;
  sample.angular_velocity =
      sensor_from_body_ * motion.inertial_rate() + gyro_bias_ + draw(noise_, param_.gyro_noise / root);
  sample.specific_force = sensor_from_body_ * motion.specific_force({param_.x, param_.y, param_.z}) +
                          accel_bias_ + draw(noise_, param_.accel_noise / root);
  return {motion.pose().time + param_.stamp_late, motion.pose().time, sample};
}

SimulatedReceiver::SimulatedReceiver(const SimulatedReceiverParam& param, std::uint64_t seed)
    : param_(param), noise_(seed, kReceiverStream) {
  for (std::uint32_t axis = 0; axis < 3; ++axis) {
    slow_.emplace_back(1.0, param.slow_time, NoiseSource(seed, kSlowStream + axis));
    multipath_.emplace_back(1.0, param.multipath_time, NoiseSource(seed, kMultipathStream + axis));
  }
  const Eigen::Vector3d direction = draw(noise_, 1.0);
  jump_ = param_.jump * Eigen::Vector3d(direction.x(), direction.y(), 0.0).normalized();
}

bool SimulatedReceiver::is_in(SkyEpisode::Kind kind, double since_start) const {
  return std::any_of(param_.sky.begin(), param_.sky.end(), [&](const SkyEpisode& episode) {
    return episode.kind == kind && episode.at(since_start);
  });
}

FixQuality SimulatedReceiver::quality_at(double since_start) const {
  if (is_in(SkyEpisode::Kind::kTunnel, since_start)) return FixQuality::kNone;
  if (is_in(SkyEpisode::Kind::kNoFix, since_start)) return FixQuality::kNoFix;
  FixQuality quality = param_.quality;
  if (is_in(SkyEpisode::Kind::kPlain, since_start)) quality = FixQuality::kPlain;
  bool floats = is_in(SkyEpisode::Kind::kFloat, since_start);
  for (const SkyEpisode& episode : param_.sky) {
    const double since_end = since_start - (episode.start + episode.duration);
    floats |= episode.kind == SkyEpisode::Kind::kTunnel && since_end >= 0.0 && since_end < param_.refix_time;
  }
  return floats ? std::min(quality, FixQuality::kFloat) : quality;
}

std::vector<SimulatedReading> SimulatedReceiver::measure(const BodyMotion& motion, double since_start) {
  SimulatedFix fix;
  fix.quality = quality_at(since_start);
  if (fix.quality == FixQuality::kNone) return {};
  const Eigen::Vector3d antenna(param_.x, param_.y, param_.z);
  const Eigen::Vector3d truth = motion.position(antenna);
  const Eigen::Matrix3d enu = enu_from_earth(to_geodetic(truth));
  const Eigen::Vector3d slow = at(slow_, since_start), reflected = at(multipath_, since_start);
  const double white = std::min(param_.fixed, 0.1 * param_.plain);
  const double of_slow = fix.quality == FixQuality::kFixed   ? param_.fixed
                         : fix.quality == FixQuality::kFloat ? param_.floating
                                                             : param_.plain;
  Eigen::Vector3d error = of_slow * slow + draw(noise_, white);
  if (is_in(SkyEpisode::Kind::kMultipath, since_start)) error += param_.multipath * reflected;
  if (is_in(SkyEpisode::Kind::kJump, since_start)) error += jump_;
  fix.place = to_geodetic(truth + enu.transpose() * error);
  fix.stddev = std::hypot(of_slow, white);
  fix.vertical_stddev = kVerticalFactor * fix.stddev;
  const double stamp = motion.pose().time + param_.stamp_late;
  const double arrival = motion.pose().time + param_.latency;
  std::vector<SimulatedReading> readings{{stamp, arrival, fix}};
  if (fix.quality == FixQuality::kNoFix) return readings;
  const Eigen::Vector3d velocity = enu * motion.velocity(antenna) + draw(noise_, param_.velocity);
  readings.push_back({stamp, arrival, SimulatedVelocity{velocity, param_.velocity}});
  return readings;
}

SimulatedWheelSensor::SimulatedWheelSensor(const SimulatedWheelParam& param, std::uint64_t seed)
    : param_(param), noise_(seed, kWheelStream) {
  scale_ = 1.0 + noise_.draw(param.scale);
  yaw_rate_bias_ = noise_.draw(param.yaw_rate_bias);
}

SimulatedReading SimulatedWheelSensor::measure(const BodyMotion& motion) {
  const Eigen::Vector3d velocity =
      motion.pose().earth_from_body.transpose() * motion.velocity(Eigen::Vector3d::Zero());
  const double noise = noise_.draw(param_.speed_noise), rate_noise = noise_.draw(param_.yaw_rate_noise);
  SimulatedWheels wheels;
  if (std::abs(velocity.x()) > 1e-3) {  // pulses come while they turn
    wheels.speed = scale_ * velocity.x() + noise;
    wheels.yaw_rate = motion.rate().z() + yaw_rate_bias_ + rate_noise;
  }
  return {motion.pose().time, motion.pose().time, wheels};
}

SensorSuite::SensorSuite(const SensorParam& param, std::uint64_t seed)
    : param_(checked(param)),
      map_(param.map, Terrain(param.terrain, seed)),
      imu_(param.imu, seed),
      receiver_(param.receiver, seed),
      wheels_(param.wheels, seed) {}

void SensorSuite::drive(double time, const Pose2& map_from_body) {
  if (known_ > 0 && time <= poses_[2].time) known_ = 0;
  if (!start_) start_ = time;
  std::rotate(poses_.begin(), poses_.begin() + 1, poses_.end());
  poses_[2] = map_.place(time, map_from_body);
  known_ = std::min(known_ + 1, 3);
  if (known_ < 3) return;
  const std::optional<BodyMotion> motion = BodyMotion::from(poses_);
  if (!motion) return;
  const double now = motion->pose().time;
  const double margin = 0.5 * motion->step();  // each falls due at the pose nearest to its time
  waiting_.push_back(imu_.measure(*motion));
  if (now + margin >= next_wheels_) {
    waiting_.push_back(wheels_.measure(*motion));
    next_wheels_ = std::max(next_wheels_ + 1.0 / param_.wheels.rate, now);
  }
  if (now + margin >= next_fix_) {
    for (SimulatedReading& reading : receiver_.measure(*motion, now - *start_)) waiting_.push_back(reading);
    next_fix_ = std::max(next_fix_ + 1.0 / param_.receiver.rate, now);
  }
}

std::vector<SimulatedReading> SensorSuite::take(double time) {
  std::stable_sort(
      waiting_.begin(), waiting_.end(),
      [](const SimulatedReading& a, const SimulatedReading& b) { return a.arrival < b.arrival; });
  const auto later = std::find_if(waiting_.begin(), waiting_.end(),
                                  [&](const SimulatedReading& reading) { return reading.arrival > time; });
  std::vector<SimulatedReading> arrived(waiting_.begin(), later);
  waiting_.erase(waiting_.begin(), later);
  return arrived;
}

}  // namespace relative_map::core
