#include "relative_map/ros/localizer/localizer_parameters.hpp"

#include <cmath>
#include <set>
#include <sstream>
#include <stdexcept>

#include "relative_map/io/geodetic_projection.hpp"

namespace relative_map {

namespace {

/// Hands parameters out by name, and keeps account of what was asked for and what was wrong.
class Keys {
 public:
  explicit Keys(const ParameterSet& parameters) : parameters_(parameters) {}

  void read(const std::string& name, double& value) {
    const Parameter* found = find(name);
    if (found == nullptr) return;
    if (const double* number = std::get_if<double>(found)) {
      value = *number;
    } else if (const int* integer = std::get_if<int>(found)) {
      value = *integer;
    } else {
      faults.push_back(name + " must be a number");
    }
  }
  void read(const std::string& name, bool& value) { read_exact(name, value, "true or false"); }
  void read(const std::string& name, std::string& value) { read_exact(name, value, "text"); }

  void name_unknown() {
    for (const auto& [name, unused] : parameters_) {
      if (known_.count(name) == 0) faults.push_back(name + " is not a parameter of the localizer");
    }
  }

  std::vector<std::string> faults;

 private:
  const Parameter* find(const std::string& name) {
    known_.insert(name);
    const auto found = parameters_.find(name);
    return found == parameters_.end() ? nullptr : &found->second;
  }
  template <class T>
  void read_exact(const std::string& name, T& value, const char* kind) {
    const Parameter* found = find(name);
    if (found == nullptr) return;
    if (const T* typed = std::get_if<T>(found)) {
      value = *typed;
    } else {
      faults.push_back(name + " must be " + kind);
    }
  }

  const ParameterSet& parameters_;
  std::set<std::string> known_;
};

void read_method(Keys& keys, core::LocalizerParam& param) {
  std::string method = "inertial";
  keys.read("method", method);
  if (method == "rtk") {
    param.method = core::Method::kRtk;
  } else if (method == "inertial") {
    param.method = core::Method::kInertial;
  } else if (method == "planar") {
    param.method = core::Method::kPlanar;
  } else {
    keys.faults.push_back("method is '" + method + "', but must be rtk, inertial or planar");
  }
}

/// "utm", "local", "33N", or "48.1, 11.5[, 520]".
void read_projection(Keys& keys, core::LocalizerParam& param) {
  std::string text = "utm";
  keys.read("projection", text);
  if (text == "utm") return;
  if (text == "local") {
    param.local_at_first_fix = true;
    return;
  }
  if (text.find(',') == std::string::npos) {
    try {
      param.reference = core::parse_utm_zone(text);
    } catch (const std::runtime_error&) {
      keys.faults.push_back(
          "projection is '" + text +
          "', but must be utm, local, a zone like 33N, or an origin like '48.1, 11.5, 520'");
    }
    return;
  }
  std::istringstream stream(text);
  core::GeoReference& reference = param.reference;
  char comma = 0;
  stream >> reference.latitude >> comma >> reference.longitude;
  bool good = stream && comma == ',';
  if (good && stream >> comma)
    good = comma == ',' && stream >> reference.altitude && (stream >> std::ws).eof();
  good = good && std::abs(reference.latitude) <= 90.0 && std::abs(reference.longitude) <= 180.0;
  if (good) {
    reference.projection = core::Projection::kLocal;
  } else {
    reference = core::GeoReference();
    keys.faults.push_back("projection is '" + text + "', but an origin is latitude, longitude[, altitude]");
  }
}

void read_imu(Keys& keys, core::InertialParam& param) {
  std::string grade = "low_cost";
  keys.read("imu_grade", grade);
  try {
    param.noise = core::imu_noise_of_grade(grade);
  } catch (const std::runtime_error& fault) {
    keys.faults.push_back(fault.what());
  }
  const auto override_by = [&keys](const std::string& name, double& value) {
    double own = 0.0;  // by the grade
    keys.read(name, own);
    if (own != 0.0) value = own;
  };
  override_by("imu_noise/gyro", param.noise.gyro_noise);
  override_by("imu_noise/accel", param.noise.accel_noise);
  override_by("imu_noise/gyro_bias_walk", param.noise.gyro_bias_walk);
  override_by("imu_noise/accel_bias_walk", param.noise.accel_bias_walk);
}

void read_filter(Keys& keys, core::InertialParam& param) {
  keys.read("gate_probability", param.gate_probability);
  keys.read("gnss_only_init", param.gnss_only_init);
  keys.read("nhc", param.nhc);
  keys.read("rolling/lateral", param.nhc_lateral);
  keys.read("rolling/vertical", param.nhc_vertical);
  keys.read("rolling/yaw_rate", param.nhc_yaw_rate);
  keys.read("rolling/min_speed", param.nhc_min_speed);
  keys.read("zero_velocity", param.zero_velocity);
  keys.read("standing/velocity_stddev", param.zero_velocity_stddev);
  keys.read("standing/rate_stddev", param.zero_rate_stddev);
  keys.read("standing/still_rate", param.still_rate);
  keys.read("standing/still_force", param.still_force);
  keys.read("wheels/speed_stddev", param.wheel_speed_stddev);
  keys.read("wheels/scale_stddev", param.wheel_scale_stddev);
  keys.read("mount_stddev", param.mount_stddev);
  keys.read("stamp_offset_stddev", param.stamp_offset_stddev);
  keys.read("alignment/course_speed", param.course_speed);
  keys.read("alignment/tilt_stddev", param.tilt_stddev);
  keys.read("alignment/yaw_stddev", param.yaw_stddev);
  keys.read("alignment/gyro_bias_stddev", param.gyro_bias_stddev);
  keys.read("alignment/accel_bias_stddev", param.accel_bias_stddev);
  keys.read("status/ok_stddev", param.ok_stddev);
  keys.read("status/warning_stddev", param.warning_stddev);
  keys.read("status/max_yaw_stddev", param.max_yaw_stddev);
}

void read_others(Keys& keys, core::LocalizerParam& param) {
  keys.read("planar/acceleration", param.planar.acceleration);
  keys.read("planar/yaw_acceleration", param.planar.yaw_acceleration);
  keys.read("planar/yaw_rate_stddev", param.planar.yaw_rate_stddev);
  keys.read("planar/yaw_rate_bias", param.planar.yaw_rate_bias);
  keys.read("planar/slip", param.planar.slip);
  keys.read("rtk/max_wait", param.rtk.max_wait);
  keys.read("rtk/max_bracket", param.rtk.max_bracket);
  keys.read("rtk/course_speed", param.rtk.course_speed);
  keys.read("rtk/ok_stddev", param.rtk.ok_stddev);
  keys.read("rtk/warning_stddev", param.rtk.warning_stddev);
  keys.read("stamp_offset/imu", param.stamp_offset.imu);
  keys.read("stamp_offset/fix", param.stamp_offset.fix);
  keys.read("stamp_offset/fix_velocity", param.stamp_offset.fix_velocity);
  keys.read("stamp_offset/heading", param.stamp_offset.heading);
  keys.read("stamp_offset/wheels", param.stamp_offset.wheels);
  keys.read("stamp_offset/map_pose", param.stamp_offset.map_pose);
  keys.read("fix_stddev", param.assumed.fix);
  keys.read("fix_velocity_stddev", param.assumed.fix_velocity);
  keys.read("heading_stddev", param.assumed.heading);
}

void read_mounts(Keys& keys, LocalizerNodeConfig& config) {
  std::string imu = "tf", antenna = "tf";
  double roll = 0.0, pitch = 0.0, yaw = 0.0;
  Eigen::Vector3d imu_place = Eigen::Vector3d::Zero(), antenna_place = Eigen::Vector3d::Zero();
  keys.read("imu_mount/from", imu);
  keys.read("imu_mount/x", imu_place.x());
  keys.read("imu_mount/y", imu_place.y());
  keys.read("imu_mount/z", imu_place.z());
  keys.read("imu_mount/roll", roll);
  keys.read("imu_mount/pitch", pitch);
  keys.read("imu_mount/yaw", yaw);
  keys.read("antenna/from", antenna);
  keys.read("antenna/x", antenna_place.x());
  keys.read("antenna/y", antenna_place.y());
  keys.read("antenna/z", antenna_place.z());
  for (const auto& [name, word] : {std::pair("imu_mount/from", imu), std::pair("antenna/from", antenna)}) {
    if (word != "tf" && word != "parameters") {
      keys.faults.push_back(std::string(name) + " is '" + word + "', but must be tf or parameters");
    }
  }
  if (!(imu_place.allFinite() && antenna_place.allFinite() && std::isfinite(roll + pitch + yaw))) {
    keys.faults.push_back("imu_mount and antenna must be finite");
  }
  if (imu == "parameters") {
    Eigen::Isometry3d base_from_imu = Eigen::Isometry3d::Identity();
    base_from_imu.translation() = imu_place;
    base_from_imu.linear() = (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) *
                              Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
                              Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
                                 .toRotationMatrix();
    config.base_from_imu = base_from_imu;
  }
  if (antenna == "parameters") config.base_from_antenna = antenna_place;
}

}  // namespace

LocalizerNodeConfig make_localizer_config(const ParameterSet& parameters) {
  LocalizerNodeConfig config;
  Keys keys(parameters);
  read_method(keys, config.localizer);
  read_projection(keys, config.localizer);
  read_imu(keys, config.localizer.inertial);
  read_filter(keys, config.localizer.inertial);
  read_others(keys, config.localizer);
  read_mounts(keys, config);
  keys.read("rate", config.localizer.rate);
  keys.read("map_frame", config.map_frame);
  keys.read("base_frame", config.base_frame);
  keys.read("publish_tf", config.publish_tf);
  keys.read("max_age/imu", config.max_age_imu);
  keys.read("max_age/fix", config.max_age_fix);
  keys.name_unknown();
  if (config.map_frame.empty()) keys.faults.push_back("map_frame must not be empty");
  if (config.base_frame.empty()) keys.faults.push_back("base_frame must not be empty");
  if (!(config.max_age_imu > 0.0)) keys.faults.push_back("max_age/imu must be above 0 s");
  if (!(config.max_age_fix > 0.0)) keys.faults.push_back("max_age/fix must be above 0 s");
  for (const std::string& fault : config.localizer.validate()) keys.faults.push_back(fault);
  if (keys.faults.empty()) return config;
  std::string text = "the configuration is refused:";
  for (const std::string& fault : keys.faults) text += "\n  - " + fault;
  throw std::runtime_error(text);
}

}  // namespace relative_map
