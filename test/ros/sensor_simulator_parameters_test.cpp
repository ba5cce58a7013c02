// config/simulator_sensors.yaml against the simulator's parameters.
#include "../../src/apps/simulation/sensor_simulator_parameters.hpp"

#include <gmock/gmock.h>

namespace relative_map {
namespace {

using testing::HasSubstr;

std::string refusal_of(const ParameterSet& parameters) {
  try {
    make_sensor_simulator_config(parameters);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

std::vector<double> numbers_of(const SensorSimulatorConfig& config) {
  const core::SensorParam& s = config.sensors;
  return {static_cast<double>(config.seed),
          s.map.latitude,
          s.map.longitude,
          s.map.altitude,
          s.terrain.slope,
          s.terrain.wavelength,
          s.imu.x,
          s.imu.y,
          s.imu.z,
          s.imu.roll,
          s.imu.pitch,
          s.imu.yaw,
          s.imu.gyro_noise,
          s.imu.accel_noise,
          s.imu.gyro_bias,
          s.imu.accel_bias,
          s.imu.gyro_bias_walk,
          s.imu.accel_bias_walk,
          s.imu.stamp_late,
          s.receiver.x,
          s.receiver.y,
          s.receiver.z,
          static_cast<double>(s.receiver.quality),
          static_cast<double>(s.receiver.sky.size()),
          s.receiver.rate,
          s.receiver.latency,
          s.receiver.stamp_late,
          s.receiver.fixed,
          s.receiver.floating,
          s.receiver.plain,
          s.receiver.slow_time,
          s.receiver.velocity,
          s.receiver.multipath,
          s.receiver.multipath_time,
          s.receiver.jump,
          s.receiver.refix_time,
          s.wheels.rate,
          s.wheels.speed_noise,
          s.wheels.scale,
          s.wheels.yaw_rate_noise,
          s.wheels.yaw_rate_bias};
}

ParameterSet shipped() {
  return read_yaml(RELATIVE_MAP_SOURCE_DIR "/config/simulator_sensors.yaml");
}

TEST(SensorSimulatorParameters, TheFileHasTheDefaults) {
  EXPECT_EQ(numbers_of(make_sensor_simulator_config(shipped())),
            numbers_of(make_sensor_simulator_config({})));
  EXPECT_EQ(numbers_of(make_sensor_simulator_config({})), numbers_of(SensorSimulatorConfig()));
  // Three numbers are one key, base_frame is no number.
  EXPECT_EQ(shipped().size(), numbers_of(SensorSimulatorConfig()).size() - 2 + 1);
}

TEST(SensorSimulatorParameters, EachKeyIsRead) {
  for (const auto& [key, value] : shipped()) {
    ParameterSet wrong = shipped();
    const bool is_text = std::holds_alternative<std::string>(value);
    wrong[key] = is_text ? Parameter(0.5) : Parameter(std::string("ten"));
    EXPECT_THAT(refusal_of(wrong), HasSubstr(key)) << key;
  }
}

TEST(SensorSimulatorParameters, EveryFaultIsNamedAtOnce) {
  const std::string text = refusal_of({{"receiver/sky", std::string("fog 3 4")},
                                       {"projection", std::string("61X")},
                                       {"wheels/rate", 0.0},
                                       {"no_such_key", 1.0}});
  for (const char* name : {"fog 3 4", "61X", "wheels/rate", "no_such_key"})
    EXPECT_THAT(text, HasSubstr(name));
}

TEST(SensorSimulatorParameters, TheSkyIsAListOfEpisodes) {
  const auto config = make_sensor_simulator_config(
      {{"receiver/sky", std::string("tunnel 50 20, jump 90 5")}, {"projection", std::string("33N")}});
  ASSERT_EQ(config.sensors.receiver.sky.size(), 2u);
  EXPECT_EQ(config.sensors.receiver.sky[1].start, 90.0);
  EXPECT_EQ(config.sensors.map.zone, 33);
}

}  // namespace
}  // namespace relative_map
