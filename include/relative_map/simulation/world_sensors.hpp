#pragma once

#include "relative_map/simulation/world.hpp"

namespace relative_map::core {

// Classes of sensors, as data sheets, benchmarks and papers tell of them; the source of each size stands in
// world_sensors.cpp.

LocalizationClass rtk();             ///< GNSS with carrier phases, and a good IMU
LocalizationClass corrected_gnss();  ///< GNSS with corrections, and an IMU: decimetres
LocalizationClass plain_gnss();      ///< one frequency; metres for minutes, and jumps
LocalizationClass fast_gnss();       ///< the same, filtered to 100 Hz with an IMU
LocalizationClass slow_gnss();       ///< the same without an IMU: 5 Hz, late, and the heading from the course
LocalizationClass slam();          ///< cameras or a lidar without closed loops: drifts, most of all in turns
LocalizationClass closing_slam();  ///< the same, put right now and then by a closed loop
LocalizationClass other_datum();   ///< right but for metres by which the map lies elsewhere
LocalizationClass dead_reckoning();  ///< wheels and a gyro from a known pose on

OdometryClass good_odometry();
OdometryClass usual_odometry();
OdometryClass cheap_odometry();  ///< a gyro that nobody calibrated, and worn tyres

CameraClass good_camera();
CameraClass usual_camera();
CameraClass poor_camera();
CameraClass aside_camera();         ///< usual, looking aside, mounted aside
CameraClass late_camera();          ///< usual, behind a loaded computer
CameraClass near_sighted_camera();  ///< usual, wide-angled: 20 m
CameraClass blind_camera();         ///< usual, dazzled for ten seconds again and again
CameraClass far_starting_camera();  ///< usual, behind a long bonnet: nothing nearer than 6 m

CameraClass deceived_camera();  ///< usual; follows kerbs, joints and old paint for seconds

RecordingClass good_recording();  ///< from an RTK receiver, in the middle of the lane
RecordingClass usual_recording();
RecordingClass swaying_recording();  ///< badly driven

}  // namespace relative_map::core
