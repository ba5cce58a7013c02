#include "relative_map/simulation/vehicle_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "relative_map/simulation/paint.hpp"

namespace relative_map::core {

namespace {

constexpr double kMaxStep = 0.02;         // [s] of the motion's integration
constexpr double kMinVisiblePaint = 5.0;  // [m]

void check(const char* name, double value, double low, double high, std::vector<std::string>& faults) {
  if (value >= low && value <= high) return;  // NaN never is
  std::ostringstream fault;
  fault << name << " is " << value << ", but must lie in [" << low << ", " << high << "]";
  faults.push_back(fault.str());
}

VehicleSimulationConfig checked(const VehicleSimulationConfig& config) {
  std::string text;
  for (const std::string& fault : config.validate()) text += (text.empty() ? "" : "; ") + fault;
  if (!text.empty()) throw std::invalid_argument(text);
  return config;
}

}  // namespace

std::vector<std::string> VehicleSimulationConfig::validate() const {
  std::vector<std::string> faults;
  check("start_s", start_s, 0.0, 1e7, faults);
  check("wander", wander, 0.0, 5.0, faults);
  check("wander_wavelength", wander_wavelength, 20.0, 1e4, faults);
  check("max_speed", speed.max_speed, 0.1, 100.0, faults);
  check("max_lateral_acceleration", speed.max_lateral_acceleration, 0.01, 20.0, faults);
  check("max_acceleration", speed.max_acceleration, 0.01, 20.0, faults);
  check("max_deceleration", speed.max_deceleration, 0.01, 20.0, faults);
  check("lane_half_width", paint.lane_half_width, 0.5, 10.0, faults);
  check("view_range", paint.view_range, 0.0, 300.0, faults);
  check("marker_quality", paint.quality, 0.0, 1.0, faults);
  check("noise/localization_position", noise.localization_position, 0.0, 100.0, faults);
  check("noise/localization_heading", noise.localization_heading, 0.0, 1.0, faults);
  check("noise/chassis_speed", noise.chassis_speed, 0.0, 100.0, faults);
  check("noise/marker_c0", noise.marker_c0, 0.0, 10.0, faults);
  check("noise/marker_c1", noise.marker_c1, 0.0, 1.0, faults);
  return faults;
}

VehicleSimulation::VehicleSimulation(const RecordedLine& line, const VehicleSimulationConfig& config)
    : config_(checked(config)),
      path_(make_drive_path(line)),
      speed_profile_(path_, config.speed),
      wander_(config.wander, config.wander_wavelength, config.seed),
      localization_noise_(config.seed, 0),
      chassis_noise_(config.seed, 1),
      marker_noise_(config.seed, 2) {
  if (path_.ends == Ends::kOpen && config.start_s >= path_.length()) {
    throw std::invalid_argument("start_s lies beyond the end of the line, which is " +
                                std::to_string(path_.length()) + " m long");
  }
  restart();
}

void VehicleSimulation::restart() {
  s_ = path_.hold(config_.start_s);
  driven_ = 0.0;
  speed_ = yaw_rate_ = 0.0;
  place();
}

void VehicleSimulation::place() {
  const PathPoint here = interpolate(path_.points, s_, vertex_);
  const Wander::Sway sway = wander_.at(driven_);
  const double stretch = 1.0 - sway.offset * here.kappa;  // of a curve beside the line
  l_ = sway.offset;
  advance_rate_ = 1.0 / std::hypot(stretch, sway.slope);
  pose_ = Pose2(here.position + l_ * left_of(here.direction),
                normalize_angle(here.theta + std::atan2(sway.slope, stretch)));
}

void VehicleSimulation::advance(double dt) {
  const double heading_before = pose_.heading();
  speed_ = std::min(speed_ + config_.speed.max_acceleration * dt, speed_profile_.limit(s_, vertex_));
  const double ds = speed_ * advance_rate_ * dt;
  s_ = path_.hold(s_ + ds);
  driven_ += ds;
  if (at_end()) speed_ = 0.0;
  place();
  yaw_rate_ = angle_difference(pose_.heading(), heading_before) / dt;
}

void VehicleSimulation::step(double dt) {
  const int steps = static_cast<int>(std::ceil(dt / kMaxStep));
  for (int i = 0; i < steps; ++i) advance(dt / steps);
  time_ += Time(std::llround(dt * 1e9));
}

Localization VehicleSimulation::measure_localization() {
  const Pose2 truth = map_from_base();
  Localization measured;
  measured.stamp = time_;
  const double error_x = localization_noise_.draw(config_.noise.localization_position);
  const double error_y = localization_noise_.draw(config_.noise.localization_position);
  measured.position = {truth.position().x() + error_x, truth.position().y() + error_y, 0.0};
  measured.heading =
      normalize_angle(truth.heading() + localization_noise_.draw(config_.noise.localization_heading));
  measured.map_from_body = Eigen::AngleAxisd(measured.heading, Eigen::Vector3d::UnitZ());
  measured.linear_velocity.head<2>() = speed_ * truth.forward();
  measured.angular_velocity_body.z() = yaw_rate_;
  return measured;
}

Chassis VehicleSimulation::measure_chassis() {
  Chassis measured;
  measured.stamp = time_;
  // Wheel sensors tell no direction: noise does not make a standing vehicle reverse.
  measured.speed = std::abs(speed_ + chassis_noise_.draw(config_.noise.chassis_speed));
  return measured;
}

LaneMarker VehicleSimulation::measure_marker(double l, BoundaryType type) {
  const double error_c0 = marker_noise_.draw(config_.noise.marker_c0);
  const double error_c1 = marker_noise_.draw(config_.noise.marker_c1);
  LaneMarker marker;
  const FittedPaint paint = fit_paint(visible_paint(path_, s_, l, pose_, config_.paint.view_range));
  if (paint.range < kMinVisiblePaint) return marker;
  marker.type = type;
  marker.quality = config_.paint.quality;
  marker.cubic = paint.cubic;
  marker.cubic.c0 += error_c0;
  marker.cubic.c1 += error_c1;
  marker.view_range = std::min(config_.paint.view_range, paint.range);
  return marker;
}

LaneMarkers VehicleSimulation::measure_lane_markers() {
  LaneMarkers measured;
  measured.stamp = time_;
  measured.left = measure_marker(config_.paint.lane_half_width, config_.paint.left_type);
  measured.right = measure_marker(-config_.paint.lane_half_width, config_.paint.right_type);
  return measured;
}

}  // namespace relative_map::core
