#pragma once

#include <geometry_msgs/TwistStamped.h>
#include <sensor_msgs/Imu.h>
#include <sensor_msgs/NavSatFix.h>

#include "relative_map/simulation/sensors/sensor_suite.hpp"

namespace relative_map {

/// Frames of the sensors, as in urdf/sample_car.urdf.
constexpr const char* kImuFrame = "imu_link";
constexpr const char* kAntennaFrame = "gnss_link";

sensor_msgs::Imu to_message(const core::SimulatedImu& sample);
sensor_msgs::NavSatFix to_message(const core::SimulatedFix& fix);
geometry_msgs::TwistStamped to_message(const core::SimulatedVelocity& velocity);
geometry_msgs::TwistStamped to_message(const core::SimulatedWheels& wheels, const std::string& base_frame);

}  // namespace relative_map
