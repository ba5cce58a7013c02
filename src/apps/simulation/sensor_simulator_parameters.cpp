#include "sensor_simulator_parameters.hpp"

#include <cmath>
#include <sstream>

#include "relative_map/io/geodetic_projection.hpp"
#include "relative_map/ros/setup/parameter_taker.hpp"

namespace relative_map {

namespace {

/// "33N", or "48.1, 11.5, 520".
core::GeoReference read_place(const std::string& text) {
  if (text.find(',') == std::string::npos) return core::parse_utm_zone(text);
  core::GeoReference place;
  std::istringstream stream(text);
  char first = 0, second = 0;
  stream >> place.latitude >> first >> place.longitude >> second >> place.altitude;
  if (!stream || first != ',' || second != ',' || std::abs(place.latitude) > 90.0 ||
      std::abs(place.longitude) > 180.0) {
    throw std::runtime_error("");
  }
  place.projection = core::Projection::kLocal;
  return place;
}

/// Episodes with commas between them.
std::vector<core::SkyEpisode> read_sky(const std::string& text) {
  std::vector<core::SkyEpisode> sky;
  std::istringstream stream(text);
  for (std::string episode; std::getline(stream, episode, ',');) {
    sky.push_back(core::parse_sky_episode(episode));
  }
  return sky;
}

}  // namespace

SensorSimulatorConfig make_sensor_simulator_config(const ParameterSet& parameters) {
  SensorSimulatorConfig config;
  core::SensorParam& sensors = config.sensors;
  ParameterTaker taker(parameters);
  double seed = 1.0;
  std::string place = "48.1, 11.5, 520", quality = "rtk", sky;
  taker.take("seed", seed);
  taker.expect("seed", seed, 0.0, 1e9);
  config.seed = static_cast<std::uint64_t>(seed);
  taker.take("base_frame", config.base_frame);
  taker.take("projection", place);
  taker.take("terrain/slope", sensors.terrain.slope);
  taker.take("terrain/wavelength", sensors.terrain.wavelength);
  taker.take("imu/x", sensors.imu.x);
  taker.take("imu/y", sensors.imu.y);
  taker.take("imu/z", sensors.imu.z);
  taker.take("imu/roll", sensors.imu.roll);
  taker.take("imu/pitch", sensors.imu.pitch);
  taker.take("imu/yaw", sensors.imu.yaw);
  taker.take("imu/gyro_noise", sensors.imu.gyro_noise);
  taker.take("imu/accel_noise", sensors.imu.accel_noise);
  taker.take("imu/gyro_bias", sensors.imu.gyro_bias);
  taker.take("imu/accel_bias", sensors.imu.accel_bias);
  taker.take("imu/gyro_bias_walk", sensors.imu.gyro_bias_walk);
  taker.take("imu/accel_bias_walk", sensors.imu.accel_bias_walk);
  taker.take("imu/stamp_late", sensors.imu.stamp_late);
  taker.take("receiver/x", sensors.receiver.x);
  taker.take("receiver/y", sensors.receiver.y);
  taker.take("receiver/z", sensors.receiver.z);
  taker.take("receiver/quality", quality);
  taker.take("receiver/sky", sky);
  taker.take("receiver/rate", sensors.receiver.rate);
  taker.take("receiver/latency", sensors.receiver.latency);
  taker.take("receiver/stamp_late", sensors.receiver.stamp_late);
  taker.take("receiver/fixed", sensors.receiver.fixed);
  taker.take("receiver/float", sensors.receiver.floating);
  taker.take("receiver/plain", sensors.receiver.plain);
  taker.take("receiver/slow_time", sensors.receiver.slow_time);
  taker.take("receiver/velocity", sensors.receiver.velocity);
  taker.take("receiver/multipath", sensors.receiver.multipath);
  taker.take("receiver/multipath_time", sensors.receiver.multipath_time);
  taker.take("receiver/jump", sensors.receiver.jump);
  taker.take("receiver/refix_time", sensors.receiver.refix_time);
  taker.take("wheels/rate", sensors.wheels.rate);
  taker.take("wheels/speed_noise", sensors.wheels.speed_noise);
  taker.take("wheels/scale", sensors.wheels.scale);
  taker.take("wheels/yaw_rate_noise", sensors.wheels.yaw_rate_noise);
  taker.take("wheels/yaw_rate_bias", sensors.wheels.yaw_rate_bias);
  try {
    sensors.map = read_place(place);
  } catch (const std::runtime_error&) {
    taker.faults.push_back("projection is '" + place + "', but must be like 33N or '48.1, 11.5, 520'");
  }
  try {
    sensors.receiver.quality = core::parse_fix_quality(quality);
    sensors.receiver.sky = read_sky(sky);
  } catch (const std::invalid_argument& fault) {
    taker.faults.push_back(fault.what());
  }
  for (std::string& fault : sensors.validate()) taker.faults.push_back(std::move(fault));
  taker.finish();
  return config;
}

}  // namespace relative_map
