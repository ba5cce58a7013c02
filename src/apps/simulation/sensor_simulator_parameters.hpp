#pragma once

#include <cstdint>

#include "relative_map/ros/setup/parameters.hpp"
#include "relative_map/simulation/sensors/sensor_param.hpp"

namespace relative_map {

/// All that the sensor simulator can be told. Defaults as in config/simulator_sensors.yaml.
struct SensorSimulatorConfig {
  core::SensorParam sensors;
  std::uint64_t seed = 1;
  std::string base_frame = "base_link";
};

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
SensorSimulatorConfig make_sensor_simulator_config(const ParameterSet& parameters);

}  // namespace relative_map
