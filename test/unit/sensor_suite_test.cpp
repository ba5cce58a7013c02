// Simulated sensors against closed forms, and integrated back to where the vehicle went.
#include "relative_map/simulation/sensors/sensor_suite.hpp"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>

namespace relative_map::core {
namespace {

constexpr double kStep = 0.01;              // [s]
constexpr double kEarthRate = 7.292115e-5;  // [rad/s] WGS 84

SensorParam exact() {
  SensorParam param;
  param.terrain.slope = 0.0;
  param.imu.gyro_noise = param.imu.accel_noise = param.imu.gyro_bias = param.imu.accel_bias = 0.0;
  param.imu.gyro_bias_walk = param.imu.accel_bias_walk = 0.0;
  param.receiver.fixed = param.receiver.velocity = param.receiver.latency = 0.0;
  param.wheels.speed_noise = param.wheels.scale = param.wheels.yaw_rate_noise = param.wheels.yaw_rate_bias =
      0.0;
  return param;
}

template <class Data>
std::vector<std::pair<double, Data>> of(const std::vector<SimulatedReading>& readings) {
  std::vector<std::pair<double, Data>> found;
  for (const SimulatedReading& reading : readings) {
    if (const auto* data = std::get_if<Data>(&reading.data)) found.emplace_back(reading.stamp, *data);
  }
  return found;
}

/// Readings of `seconds` along a pose that is a function of the time since 100 s.
template <class Path>
std::vector<SimulatedReading> along(const SensorParam& param, double seconds, const Path& path,
                                    std::uint64_t seed = 1) {
  SensorSuite suite(param, seed);
  for (int i = 0; i * kStep <= seconds; ++i) suite.drive(100.0 + i * kStep, path(i * kStep));
  return suite.take(1e9);
}

Pose2 standing(double) {
  return Pose2({0.0, 0.0}, 0.5);
}
Pose2 circling(double t) {  // 10 m/s, radius 50 m
  return Pose2({50.0 * std::sin(0.2 * t), 50.0 - 50.0 * std::cos(0.2 * t)}, normalize_angle(0.2 * t));
}

TEST(SensorSuite, StandingItFeelsGravityAndTheEarthsTurn) {
  const auto samples = of<SimulatedImu>(along(exact(), 1.0, standing));
  ASSERT_EQ(samples.size(), 99u);
  const double latitude = 48.1 * M_PI / 180.0, north = kEarthRate * std::cos(latitude);
  for (const auto& [stamp, sample] : samples) {
    EXPECT_NEAR(sample.specific_force.z(), 9.8075, 1e-3);  // at 48.1 degrees, 520 m up
    EXPECT_LT(sample.specific_force.head<2>().norm(), 1e-4);
    EXPECT_NEAR(sample.angular_velocity.z(), kEarthRate * std::sin(latitude), 1e-8);
    EXPECT_NEAR(sample.angular_velocity.x(), north * std::sin(0.5), 1e-8);
    EXPECT_NEAR(sample.angular_velocity.y(), north * std::cos(0.5), 1e-8);
  }
}

TEST(SensorSuite, OnACircleItFeelsTheCentripetalForceAtItsPlace) {
  SensorParam param = exact();
  param.imu.x = 3.0;
  param.imu.y = -1.0;
  for (const auto& [stamp, sample] : of<SimulatedImu>(along(param, 5.0, circling))) {
    EXPECT_NEAR(sample.angular_velocity.z(), 0.2, 1e-4);
    // v^2 / r of the axle, and w^2 of the lever to its place; the rest is Coriolis's.
    EXPECT_NEAR(sample.specific_force.x(), -0.04 * 3.0, 3e-3);
    EXPECT_NEAR(sample.specific_force.y(), 2.0 + 0.04 * 1.0, 3e-3);
  }
}

TEST(SensorSuite, AMountTurnsItsAxes) {
  SensorParam param = exact();
  param.imu.roll = M_PI / 2.0;  // its y points up, its z to the right
  const auto [stamp, sample] = of<SimulatedImu>(along(param, 1.0, standing)).front();
  EXPECT_NEAR(sample.specific_force.y(), 9.8075, 1e-3);
  EXPECT_LT(std::abs(sample.specific_force.z()), 1e-3);
}

TEST(SensorSuite, IntegratedItsSamplesLeadAlongTheDrive) {
  SensorParam param = exact();
  param.terrain.slope = 0.03;
  param.imu.x = param.imu.y = param.imu.z = 0.0;
  SensorSuite suite(param, 5);
  std::vector<EarthPose> truth;
  for (int i = 0; i <= 6000; ++i) {
    suite.drive(100.0 + i * kStep, circling(i * kStep));
    truth.push_back(suite.latest());
  }
  // Strapdown in the earth's frame: the plainest there is.
  Eigen::Vector3d position = truth[1].position,
                  velocity = (truth[2].position - truth[0].position) / (2 * kStep);
  Eigen::Matrix3d attitude = truth[1].earth_from_body;
  const Eigen::Vector3d earth(0.0, 0.0, kEarthRate);
  const auto samples = of<SimulatedImu>(suite.take(1e9));
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    const Eigen::Vector3d rate =
        0.5 * (samples[i].second.angular_velocity + samples[i + 1].second.angular_velocity);
    const Eigen::Vector3d force =
        0.5 * (samples[i].second.specific_force + samples[i + 1].second.specific_force);
    const Eigen::Vector3d turn = kStep * (rate - attitude.transpose() * earth);
    const Eigen::Matrix3d half = attitude * Eigen::AngleAxisd(0.5 * turn.norm(), turn.normalized());
    const double r = position.norm(), s = position.z() / r;  // gravity with J2, and the centrifugal force
    const double k = 1.5 * 1.08262982e-3 * std::pow(6378137.0 / r, 2), mu = 3.986004418e14 / (r * r * r);
    const Eigen::Vector3d pull(-mu * position.x() * (1 + k * (1 - 5 * s * s)),
                               -mu * position.y() * (1 + k * (1 - 5 * s * s)),
                               -mu * position.z() * (1 + k * (3 - 5 * s * s)));
    const Eigen::Vector3d acceleration =
        half * force + pull - 2.0 * earth.cross(velocity) - earth.cross(earth.cross(position));
    position += kStep * (velocity + 0.5 * kStep * acceleration);
    velocity += kStep * acceleration;
    attitude = attitude * Eigen::AngleAxisd(turn.norm(), turn.normalized());
  }
  EXPECT_LT((position - truth[samples.size()].position).norm(), 0.3);  // after 600 m
  EXPECT_LT(Eigen::AngleAxisd(Eigen::Matrix3d(attitude.transpose() * truth[samples.size()].earth_from_body))
                .angle(),
            1e-4);
}

TEST(SensorSuite, TheReceiverSeesItsAntenna) {
  SensorParam param = exact();
  param.receiver.x = 2.0;
  param.receiver.z = 1.0;
  param.receiver.plain = 0.0;
  const auto fixes = of<SimulatedFix>(along(param, 2.0, [](double) { return Pose2({10.0, 20.0}, 0.0); }));
  ASSERT_GE(fixes.size(), 9u);
  const GeographicLib::LocalCartesian plane(48.1, 11.5, 520.0);
  double x, y, z;
  const GeoPoint& place = fixes.front().second.place;
  plane.Forward(place.latitude, place.longitude, place.altitude, x, y, z);
  EXPECT_NEAR(x, 12.0, 1e-6);
  EXPECT_NEAR(y, 20.0, 1e-6);
}

TEST(SensorSuite, NoiseIsAsDenseAsAskedForAtAnyRate) {
  SensorParam param = exact();
  param.imu.gyro_noise = 1e-3;
  double sum = 0.0;
  const auto samples = of<SimulatedImu>(along(param, 50.0, standing));
  for (const auto& [stamp, sample] : samples) {
    sum += std::pow(sample.angular_velocity.z() - kEarthRate * std::sin(48.1 * M_PI / 180.0), 2);
  }
  const double density = std::sqrt(sum / static_cast<double>(samples.size()) * kStep);
  EXPECT_NEAR(density, 1e-3, 3e-5);
}

TEST(SensorSuite, ATunnelIsSilentAndTheReceiverFloatsAfterIt) {
  SensorParam param;
  param.receiver.sky = {parse_sky_episode("tunnel 5 10"), parse_sky_episode("no_fix 25 2")};
  std::map<FixQuality, int> seen;
  for (const auto& [stamp, fix] : of<SimulatedFix>(along(param, 30.0, standing))) {
    const double t = stamp - 100.0;
    EXPECT_TRUE(t < 5.0 || t >= 14.99) << t;
    ++seen[fix.quality];
    if (t > 15.0 && t < 18.9) {
      EXPECT_EQ(fix.quality, FixQuality::kFloat) << t;
    }
  }
  EXPECT_NEAR(seen[FixQuality::kFloat], 20, 1);
  EXPECT_NEAR(seen[FixQuality::kNoFix], 10, 1);
}

TEST(SensorSuite, LateMessagesComeLateWithTheirOwnStamps) {
  SensorParam param;
  param.receiver.latency = 0.3;
  SensorSuite suite(param, 1);
  for (int i = 0; i < 200; ++i) {
    const double now = 100.0 + i * kStep;
    suite.drive(now, standing(0.0));
    for (const auto& [stamp, fix] : of<SimulatedFix>(suite.take(now))) EXPECT_NEAR(now - stamp, 0.3, 0.02);
  }
}

TEST(SensorSuite, TheSameSeedGivesTheSameReadings) {
  const auto first = of<SimulatedFix>(along(SensorParam(), 5.0, circling, 7));
  const auto second = of<SimulatedFix>(along(SensorParam(), 5.0, circling, 7));
  const auto other = of<SimulatedFix>(along(SensorParam(), 5.0, circling, 8));
  EXPECT_EQ(first.back().second.place.latitude, second.back().second.place.latitude);
  EXPECT_NE(first.back().second.place.latitude, other.back().second.place.latitude);
}

TEST(SensorSuite, WhatIsImpossibleIsRefusedByName) {
  SensorParam param;
  param.receiver.rate = 0.0;
  param.imu.gyro_noise = -1.0;
  EXPECT_EQ(param.validate().size(), 2u);
  EXPECT_THROW(SensorSuite(param, 1), std::invalid_argument);
  EXPECT_THROW(parse_sky_episode("tunnel five 3"), std::invalid_argument);
  EXPECT_THROW(parse_sky_episode("fog 5 3"), std::invalid_argument);
}

}  // namespace
}  // namespace relative_map::core
