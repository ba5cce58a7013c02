#include "relative_map/simulation/sensors/sensor_param.hpp"

#include <cmath>
#include <map>
#include <sstream>
#include <stdexcept>

#include "relative_map/model/check_range.hpp"

namespace relative_map::core {

std::vector<std::string> SensorParam::validate() const {
  std::vector<std::string> faults;
  if (map.projection == Projection::kNone) faults.push_back("the map's place on the earth is not given");
  check_range("terrain/slope", terrain.slope, 0.0, 0.2, faults);
  check_range("terrain/wavelength", terrain.wavelength, 50.0, 1e5, faults);
  for (const double lever : {imu.x, imu.y, imu.z, receiver.x, receiver.y, receiver.z}) {
    check_range("a sensor's place", lever, -20.0, 20.0, faults);
  }
  for (const double angle : {imu.roll, imu.pitch, imu.yaw})
    check_range("imu's angle", angle, -3.2, 3.2, faults);
  check_range("imu/gyro_noise", imu.gyro_noise, 0.0, 1.0, faults);
  check_range("imu/accel_noise", imu.accel_noise, 0.0, 10.0, faults);
  check_range("imu/gyro_bias", imu.gyro_bias, 0.0, 1.0, faults);
  check_range("imu/accel_bias", imu.accel_bias, 0.0, 10.0, faults);
  check_range("imu/gyro_bias_walk", imu.gyro_bias_walk, 0.0, 1.0, faults);
  check_range("imu/accel_bias_walk", imu.accel_bias_walk, 0.0, 1.0, faults);
  check_range("imu/stamp_late", imu.stamp_late, -1.0, 1.0, faults);
  check_range("receiver/rate", receiver.rate, 0.1, 50.0, faults);
  check_range("receiver/latency", receiver.latency, 0.0, 1.0, faults);
  check_range("receiver/stamp_late", receiver.stamp_late, -1.0, 1.0, faults);
  check_range("receiver/fixed", receiver.fixed, 0.0, 1.0, faults);
  check_range("receiver/float", receiver.floating, 0.0, 10.0, faults);
  check_range("receiver/plain", receiver.plain, 0.0, 100.0, faults);
  check_range("receiver/slow_time", receiver.slow_time, 0.1, 1e5, faults);
  check_range("receiver/velocity", receiver.velocity, 0.0, 10.0, faults);
  check_range("receiver/multipath", receiver.multipath, 0.0, 1000.0, faults);
  check_range("receiver/multipath_time", receiver.multipath_time, 0.1, 1e5, faults);
  check_range("receiver/jump", receiver.jump, 0.0, 1e5, faults);
  check_range("receiver/refix_time", receiver.refix_time, 0.0, 1000.0, faults);
  check_range("wheels/rate", wheels.rate, 0.1, 100.0, faults);
  check_range("wheels/speed_noise", wheels.speed_noise, 0.0, 10.0, faults);
  check_range("wheels/scale", wheels.scale, 0.0, 0.3, faults);
  check_range("wheels/yaw_rate_noise", wheels.yaw_rate_noise, 0.0, 1.0, faults);
  check_range("wheels/yaw_rate_bias", wheels.yaw_rate_bias, 0.0, 1.0, faults);
  return faults;
}

SkyEpisode parse_sky_episode(const std::string& text) {
  static const std::map<std::string, SkyEpisode::Kind> kKinds = {
      {"tunnel", SkyEpisode::Kind::kTunnel},       {"no_fix", SkyEpisode::Kind::kNoFix},
      {"plain", SkyEpisode::Kind::kPlain},         {"float", SkyEpisode::Kind::kFloat},
      {"multipath", SkyEpisode::Kind::kMultipath}, {"jump", SkyEpisode::Kind::kJump}};
  std::istringstream words(text);
  std::string kind, rest;
  SkyEpisode episode;
  if (!(words >> kind >> episode.start >> episode.duration) || words >> rest || kKinds.count(kind) == 0 ||
      episode.start < 0.0 || episode.duration < 0.0) {
    throw std::invalid_argument("'" + text +
                                "' is no episode: KIND START DURATION, with tunnel, no_fix, plain, float, "
                                "multipath or jump, and seconds since the start");
  }
  episode.kind = kKinds.at(kind);
  return episode;
}

FixQuality parse_fix_quality(const std::string& text) {
  if (text == "rtk") return FixQuality::kFixed;
  if (text == "float") return FixQuality::kFloat;
  if (text == "plain") return FixQuality::kPlain;
  throw std::invalid_argument("'" + text + "' is no quality of fixes: rtk, float or plain");
}

}  // namespace relative_map::core
