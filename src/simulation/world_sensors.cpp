#include "relative_map/simulation/world_sensors.hpp"

namespace relative_map::core {

namespace {

constexpr double kDegree = kPi / 180.0;

}  // namespace

LocalizationClass rtk() {
  // Data sheets of survey-grade GNSS/INS: 2 cm, 0.1 degrees, 0.05 km/h, 100 Hz, delivered within
  // milliseconds.
  LocalizationClass c;
  c.position_noise = 0.01;
  c.heading_noise = 0.05 * kDegree;
  c.velocity_noise = 0.02;
  c.errors.bias = 0.02;
  c.errors.bias_time = 120.0;  // fixes of the phases last
  c.errors.heading_bias = 0.1 * kDegree;
  c.errors.heading_bias_time = 60.0;
  c.transmission = {95.0, 105.0, 0.002, 0.01};
  return c;
}

LocalizationClass corrected_gnss() {
  // Automotive GNSS with corrections and a MEMS IMU: 0.2 to 0.5 m (one sigma), 0.3 degrees, 50 Hz.
  LocalizationClass c;
  c.position_noise = 0.03;
  c.heading_noise = 0.1 * kDegree;
  c.velocity_noise = 0.05;
  c.errors.bias = 0.35;
  c.errors.bias_time = 45.0;  // multipath and satellites change within a minute of driving
  c.errors.heading_bias = 0.35 * kDegree;
  c.errors.heading_bias_time = 40.0;
  c.transmission = {40.0, 60.0, 0.005, 0.03};
  return c;
}

LocalizationClass plain_gnss() {
  // Single-frequency receivers with SBAS state 1 to 1.5 m (one sigma). Ionosphere and multipath last for
  // minutes; the solution jumps by metres when satellites come and go between houses. 10 Hz over UDP or a
  // serial line: messages get lost, are sent twice, and overtake each other.
  LocalizationClass c;
  c.position_noise = 0.08;
  c.heading_noise = 0.4 * kDegree;
  c.velocity_noise = 0.1;
  c.errors.bias = 1.1;
  c.errors.bias_time = 90.0;
  c.errors.heading_bias = 0.5 * kDegree;
  c.errors.heading_bias_time = 60.0;
  c.errors.jump = {25.0, 5.0, 20.0};
  c.errors.min_jump = 0.5;
  c.errors.max_jump = 4.0;
  c.transmission = {10.0, 10.0, 0.02, 0.08, 0.02, 0.02, 0.01, 0.5};
  return c;
}

LocalizationClass fast_gnss() {
  // An IMU fills the gaps and makes the noise white and small; bias and jumps are the receiver's.
  LocalizationClass c = plain_gnss();
  c.position_noise = 0.03;
  c.heading_noise = 0.1 * kDegree;
  c.transmission = {100.0, 100.0, 0.005, 0.02, 0.01, 0.01, 0.01, 0.1};
  return c;
}

LocalizationClass slow_gnss() {
  LocalizationClass c = plain_gnss();
  c.errors.bias = 1.5;
  c.errors.bias_time = 180.0;       // minutes
  c.errors.jump.interval = 0.0;     // open sky
  c.heading_noise = 0.8 * kDegree;  // 0.1 m/s across a course of 7 to 15 m/s
  c.transmission = {5.0, 5.0, 0.05, 0.15, 0.03, 0.03, 0.02, 0.6};
  return c;
}

LocalizationClass slam() {
  // The KITTI odometry benchmark: good methods drift by 0.5 to 1.2 % of the way, and by 0.2 to 0.4 degrees
  // in 100 m, most of it in turns. 10 Hz, computed in 50 to 100 ms.
  LocalizationClass c;
  c.position_noise = 0.02;
  c.heading_noise = 0.05 * kDegree;
  c.velocity_noise = 0.05;
  c.errors.bias = 0.2;  // where it was put on the map
  c.errors.bias_time = 1e5;
  c.errors.heading_bias = 0.2 * kDegree;
  c.errors.heading_bias_time = 1e5;
  c.errors.pose_drift.distance_scale = 0.008;
  c.errors.pose_drift.turn_scale = 0.01;
  c.errors.pose_drift.heading_walk = 0.03 * kDegree;  // 0.3 degrees in 100 m
  c.transmission = {10.0, 10.0, 0.05, 0.1};
  return c;
}

LocalizationClass closing_slam() {
  LocalizationClass c = slam();
  c.errors.pose_drift.closed_after = 25.0;  // a familiar place every few hundred metres
  return c;
}

LocalizationClass other_datum() {
  // WGS 84 and ETRS89 lie 0.8 m apart, national grids and an antenna's lever arm that nobody entered 1 to 5
  // m.
  LocalizationClass c = corrected_gnss();
  c.errors.bias = 3.5;
  c.errors.bias_time = 1e5;
  return c;
}

LocalizationClass dead_reckoning() {
  // The vehicle's own gyro and wheels from a known pose on, as in a tunnel. Their white noise is in the
  // heading's walk: an angle random walk of 0.3 degrees in an hour's square root is 0.0013 degrees in a metre
  // at 15 m/s; slip and bumps make ten times as much of it.
  LocalizationClass c;
  c.errors.bias = 0.1;
  c.errors.bias_time = 1e5;
  c.errors.heading_bias = 0.1 * kDegree;
  c.errors.heading_bias_time = 1e5;
  c.errors.pose_drift.dead_reckoned = true;
  c.errors.pose_drift.heading_walk = 0.013 * kDegree;
  c.transmission = {50.0, 100.0, 0.0, 0.02};
  return c;
}

OdometryClass good_odometry() {
  // A tactical MEMS gyro whose bias an INS knows, and wheels that are calibrated by GNSS.
  OdometryClass c;
  c.yaw_rate_noise = 0.05 * kDegree;
  c.yaw_rate_bias = 0.01 * kDegree;
  c.yaw_rate_scale = 0.001;
  c.speed_noise = 0.02;
  c.speed_scale = 0.003;
  return c;
}

OdometryClass usual_odometry() {
  // The gyro of a stability control: 0.1 degrees/s after its calibration at rest, 0.5 % of scale. Wheels wear
  // by 1 % of their radius in a year.
  OdometryClass c;
  c.yaw_rate_noise = 0.15 * kDegree;
  c.yaw_rate_bias = 0.1 * kDegree;
  c.yaw_rate_scale = 0.005;
  c.speed_noise = 0.05;
  c.speed_scale = 0.012;
  return c;
}

OdometryClass cheap_odometry() {
  // A consumer's MEMS gyro: its turn-on bias is up to 0.6 degrees/s, its scale off by 1 to 2 %. Tyres of
  // another size or pressure change the speed by up to 3 %.
  OdometryClass c;
  c.yaw_rate_noise = 0.2 * kDegree;
  c.yaw_rate_bias = 0.6 * kDegree;
  c.yaw_rate_scale = 0.015;
  c.speed_noise = 0.08;
  c.speed_scale = 0.03;
  c.transmission = {18.0, 22.0};
  return c;
}

CameraClass good_camera() {
  // Series cameras state 5 cm beside the vehicle, and 0.2 to 0.3 m at 50 m.
  CameraClass c;
  c.noise = {0.02, 0.0016, 4e-5, 6e-7};
  c.range = 65.0;
  c.errors.correlated_share = 0.6;
  c.errors.correlation_time = 0.8;
  c.errors.view_range_change = 8.0;
  c.errors.max_view_range = 90.0;
  c.errors.dropout = {30.0, 0.2, 1.5};
  c.errors.min_latency = 0.04;
  c.errors.max_latency = 0.06;
  c.transmission = {18.0, 22.0};
  return c;
}

CameraClass usual_camera() {
  // Lane detection that someone built himself: 5 to 8 cm near, half a metre at 50 m; lost where paint is worn
  // or covered; now and then a joint, a shadow or a kerb is taken for paint.
  CameraClass c;
  c.noise = {0.045, 0.004, 8e-5, 1.5e-6};
  c.range = 45.0;
  c.errors.correlated_share = 0.6;
  c.errors.correlation_time = 1.2;
  c.errors.common_share = 0.2;
  c.errors.view_range_change = 10.0;
  c.errors.min_view_range = 20.0;
  c.errors.dropout = {9.0, 0.2, 3.0};
  c.errors.outlier = {15.0, 0.1, 1.2};
  c.errors.min_jump = 0.8;
  c.errors.max_jump = 3.2;
  c.errors.min_latency = 0.07;
  c.errors.max_latency = 0.12;
  c.transmission = {10.0, 13.0};
  return c;
}

CameraClass poor_camera() {
  // Rain or night: 10 to 15 cm near, short sight. Pitch and roll of the vehicle move all paint of an image
  // together (1 degree of roll 1.4 m above the road is 2.5 cm), for as long as the load or the bank lasts.
  CameraClass c = usual_camera();
  c.noise = {0.1, 0.009, 1.8e-4, 3e-6};
  c.range = 30.0;
  c.errors.correlated_share = 0.8;
  c.errors.correlation_time = 5.0;
  c.errors.common_share = 0.4;
  c.errors.min_view_range = 15.0;
  c.errors.max_view_range = 45.0;
  c.errors.dropout = {5.0, 0.3, 5.0};
  c.errors.outlier = {8.0, 0.1, 2.0};
  return c;
}

CameraClass aside_camera() {
  // A bracket that was put back after a new windscreen: a degree, and some centimetres.
  CameraClass c = usual_camera();
  c.errors.yaw = 0.7 * kDegree;
  c.errors.lateral = -0.06;
  return c;
}

CameraClass late_camera() {
  // A neural network on a computer that does much else: 60 ms when idle, 250 ms when not.
  CameraClass c = usual_camera();
  c.errors.min_latency = 0.06;
  c.errors.max_latency = 0.25;
  return c;
}

CameraClass near_sighted_camera() {
  // Surround-view cameras see lanes up to 12 to 25 m.
  CameraClass c = usual_camera();
  c.noise = {0.03, 0.006, 5e-4, 1e-5};
  c.range = 17.0;
  c.errors.view_range_change = 3.0;
  c.errors.min_view_range = 12.0;
  c.errors.max_view_range = 22.0;
  return c;
}

CameraClass blind_camera() {
  // A low sun, wet asphalt, a lorry ahead, snow: no paint for ten seconds.
  CameraClass c = usual_camera();
  c.errors.blind = {12.0, 8.0, 12.0};
  return c;
}

CameraClass far_starting_camera() {
  // The bonnet of a lorry or a van hides the road up to there.
  CameraClass c = usual_camera();
  c.errors.nearest = 6.0;
  return c;
}

CameraClass deceived_camera() {
  // Kerbs, tar joints, tyre tracks in snow and removed paint run beside the paint for seconds.
  CameraClass c = usual_camera();
  c.errors.outlier = {12.0, 0.5, 4.0};
  c.errors.min_jump = 0.3;
  c.errors.max_jump = 1.4;
  return c;
}

RecordingClass good_recording() {
  // A careful driver keeps the middle within 5 to 10 cm; the receiver is off by 2 cm.
  return {{0.04, 0.05, 70.0}, 0.3};
}

RecordingClass usual_recording() {
  // Naturalistic driving: drivers sit 0.1 to 0.2 m off the middle, and sway by as much.
  return {{0.15, 0.12, 55.0}, 0.5};
}

RecordingClass swaying_recording() {
  // Inattentive driving: a standard deviation of lane position of 0.35 m, at 0.1 to 0.3 Hz.
  return {{0.3, 0.35, 40.0}, 0.8};
}

}  // namespace relative_map::core
