#include "relative_map/localization/inertial_filter/inertial_param.hpp"

#include <sstream>
#include <stdexcept>

namespace relative_map::core {

ImuNoise imu_noise_of_grade(const std::string& grade) {
  if (grade == "phone") return {4e-3, 1e-1, 5e-5, 2e-3};
  if (grade == "low_cost") return {2e-3, 5e-2, 2e-5, 1e-3};
  if (grade == "tactical") return {5e-4, 1e-2, 3e-6, 3e-4};
  throw std::runtime_error("imu_grade is '" + grade + "', but must be phone, low_cost or tactical");
}

std::vector<std::string> InertialParam::validate() const {
  std::vector<std::string> faults;
  const auto expect = [&faults](const char* name, double value, double low, double high) {
    if (value >= low && value <= high) return;
    std::ostringstream sentence;
    sentence << name << " is " << value << ", but must be between " << low << " and " << high;
    faults.push_back(sentence.str());
  };
  expect("imu_noise/gyro", noise.gyro_noise, 1e-7, 1.0);
  expect("imu_noise/accel", noise.accel_noise, 1e-6, 10.0);
  expect("imu_noise/gyro_bias_walk", noise.gyro_bias_walk, 0.0, 0.1);
  expect("imu_noise/accel_bias_walk", noise.accel_bias_walk, 0.0, 1.0);
  expect("gate_probability", gate_probability, 1e-12, 0.1);
  expect("rolling/lateral", nhc_lateral, 1e-3, 10.0);
  expect("rolling/vertical", nhc_vertical, 1e-3, 10.0);
  expect("rolling/yaw_rate", nhc_yaw_rate, 0.0, 100.0);
  expect("rolling/min_speed", nhc_min_speed, 0.0, 100.0);
  expect("standing/velocity_stddev", zero_velocity_stddev, 1e-4, 1.0);
  expect("standing/rate_stddev", zero_rate_stddev, 1e-6, 1.0);
  expect("standing/still_rate", still_rate, 1e-4, 1.0);
  expect("standing/still_force", still_force, 1e-3, 10.0);
  expect("wheels/speed_stddev", wheel_speed_stddev, 1e-3, 10.0);
  expect("wheels/scale_stddev", wheel_scale_stddev, 0.0, 0.5);
  expect("mount_stddev", mount_stddev, 0.0, 0.5);
  expect("stamp_offset_stddev", stamp_offset_stddev, 0.0, 1.0);
  expect("alignment/course_speed", course_speed, 0.1, 50.0);
  expect("alignment/tilt_stddev", tilt_stddev, 1e-4, 0.5);
  expect("alignment/yaw_stddev", yaw_stddev, 1e-4, 1.0);
  expect("alignment/gyro_bias_stddev", gyro_bias_stddev, 1e-7, 1.0);
  expect("alignment/accel_bias_stddev", accel_bias_stddev, 1e-6, 10.0);
  expect("status/ok_stddev", ok_stddev, 1e-3, 100.0);
  expect("status/warning_stddev", warning_stddev, ok_stddev, 1000.0);
  expect("status/max_yaw_stddev", max_yaw_stddev, 1e-4, 3.0);
  return faults;
}

}  // namespace relative_map::core
