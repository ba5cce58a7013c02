#include "relative_map/simulation/vehicle_simulation.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "relative_map/model/check_range.hpp"
#include "relative_map/simulation/smooth_step.hpp"

namespace relative_map::core {

namespace {

constexpr double kMaxStep = 0.02;         // [s] of the motion's integration
constexpr double kMinVisiblePaint = 5.0;  // [m]

VehicleSimulationConfig checked(const VehicleSimulationConfig& config) {
  std::string text;
  for (const std::string& fault : config.validate()) text += (text.empty() ? "" : "; ") + fault;
  if (!text.empty()) throw std::invalid_argument(text);
  return config;
}

}  // namespace

std::vector<std::string> VehicleSimulationConfig::validate() const {
  std::vector<std::string> faults;
  check_range("start_s", start_s, 0.0, 1e7, faults);
  check_range("stop_s", stop_s, 0.0, 1e7, faults);
  check_range("wander", wander, 0.0, 5.0, faults);
  check_range("wander_wavelength", wander_wavelength, 20.0, 1e4, faults);
  check_range("max_speed", speed.max_speed, 0.1, 100.0, faults);
  check_range("max_lateral_acceleration", speed.max_lateral_acceleration, 0.01, 20.0, faults);
  check_range("max_acceleration", speed.max_acceleration, 0.01, 20.0, faults);
  check_range("max_deceleration", speed.max_deceleration, 0.01, 20.0, faults);
  check_range("lane_half_width", paint.lane_half_width, 0.5, 10.0, faults);
  check_range("view_range", paint.view_range, 0.0, 300.0, faults);
  check_range("marker_quality", paint.quality, 0.0, 1.0, faults);
  check_range("noise/localization_position", noise.localization_position, 0.0, 100.0, faults);
  check_range("noise/localization_heading", noise.localization_heading, 0.0, 1.0, faults);
  check_range("noise/chassis_speed", noise.chassis_speed, 0.0, 100.0, faults);
  check_range("noise/marker_c0", noise.marker_c0, 0.0, 10.0, faults);
  check_range("noise/marker_c1", noise.marker_c1, 0.0, 1.0, faults);
  check_range("noise/marker_c2", noise.marker_c2, 0.0, 0.1, faults);
  check_range("noise/marker_c3", noise.marker_c3, 0.0, 0.01, faults);
  check_range("noise/yaw_rate", noise.yaw_rate, 0.0, 1.0, faults);
  check_range("offset", offset, -50.0, 50.0, faults);
  for (const LaneChange& change : lane_changes) {
    check_range("lane change length", change.length, 1.0, 1e4, faults);
  }
  for (const SpeedChange& change : speed_changes) {
    check_range("speed change", change.speed, -10.0, 100.0, faults);
  }
  if (!std::is_sorted(paint.lines.begin(), paint.lines.end(),
                      [](const PaintLine& a, const PaintLine& b) { return a.l > b.l; })) {
    faults.push_back("the lines of paint do not lie from left to right");
  }
  check_range("max_turn", paint.max_turn, 0.01, 1.2, faults);
  check_range("max_residual", paint.max_residual, 1e-3, 1.0, faults);
  check_range("min_radius", paint.min_radius, 0.0, 1e4, faults);
  check_range("noise/localization_velocity", noise.localization_velocity, 0.0, 10.0, faults);
  for (std::string& fault : errors.validate()) faults.push_back(std::move(fault));
  return faults;
}

VehicleSimulation::VehicleSimulation(const RecordedLine& line, const VehicleSimulationConfig& config)
    : config_(checked(config)),
      path_(make_drive_path(line)),
      speed_profile_(path_, config.speed, config.stop_s),
      wander_(config.wander, config.wander_wavelength, config.seed),
      localization_noise_(config.seed, 0),
      chassis_noise_(config.seed, 1),
      velocity_noise_(config.seed, 3),
      localization_errors_(config.errors.localization, config.seed),
      marker_errors_(
          config.errors.markers,
          {config.noise.marker_c0, config.noise.marker_c1, config.noise.marker_c2, config.noise.marker_c3},
          config.seed) {
  std::mt19937_64 engine = random_engine(config.seed, 2);
  speed_scale_ =
      1.0 + config.errors.chassis.speed_scale * std::uniform_real_distribution<double>(-1.0, 1.0)(engine);
  if (config.errors.localization.pose_drift.active()) {
    pose_drift_.emplace(config.errors.localization.pose_drift, speed_scale_,
                        localization_errors_.yaw_rate_scale(), localization_errors_.yaw_rate_bias(),
                        config.seed);
  }
  PaintParam& paint = config_.paint;
  if (paint.lines.empty()) {
    paint.lines = {{paint.lane_half_width, paint.left_type}, {-paint.lane_half_width, paint.right_type}};
  }
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
  if (pose_drift_) pose_drift_->restart();
}

void VehicleSimulation::place() {
  const PathPoint here = interpolate(path_.points, s_, vertex_);
  Wander::Sway sway = wander_.at(driven_);
  sway.offset += config_.offset;
  for (const LaneChange& change : config_.lane_changes) {
    const SmoothStep step = smooth_step((driven_ - change.start) / change.length);
    sway.offset += change.shift * step.value;
    sway.slope += change.shift * step.slope / change.length;
  }
  const double stretch = 1.0 - sway.offset * here.kappa;  // of a curve beside the line
  l_ = sway.offset;
  advance_rate_ = 1.0 / std::hypot(stretch, sway.slope);
  pose_ = Pose2(here.position + l_ * left_of(here.direction),
                normalize_angle(here.theta + std::atan2(sway.slope, stretch)));
}

double VehicleSimulation::wished_speed() const {
  double speed = config_.speed.max_speed;
  for (const SpeedChange& change : config_.speed_changes) {
    if (to_seconds(time_) >= change.time) speed = change.speed;
  }
  return speed;
}

void VehicleSimulation::advance(double dt) {
  const double heading_before = pose_.heading();
  speed_ = std::clamp(wished_speed(), speed_ - config_.speed.max_deceleration * dt,
                      speed_ + config_.speed.max_acceleration * dt);
  speed_ = std::min(speed_, speed_profile_.limit(s_, vertex_));
  const double ds = speed_ * advance_rate_ * dt;
  s_ = path_.hold(s_ + ds);
  driven_ += ds;
  if (at_end() && speed_ > 0.0) speed_ = 0.0;
  place();
  yaw_rate_ = angle_difference(pose_.heading(), heading_before) / dt;
}

void VehicleSimulation::step(double dt) {
  const int steps = static_cast<int>(std::ceil(dt / kMaxStep));
  const Duration start = time_;
  for (int i = 1; i <= steps; ++i) {
    advance(dt / steps);
    time_ = start + from_seconds(dt * i / steps);
  }
}

Localization VehicleSimulation::measure_localization() {
  const double seconds = to_seconds(time_);
  const Pose2 truth = pose_drift_ ? pose_drift_->at(map_from_base(), seconds) : map_from_base();
  Localization measured;
  measured.stamp = Time(time_);
  const Point2 bias = localization_errors_.position_bias(seconds);
  const double error_x = localization_noise_.draw(config_.noise.localization_position);
  const double error_y = localization_noise_.draw(config_.noise.localization_position);
  measured.position = {truth.position().x() + bias.x() + error_x, truth.position().y() + bias.y() + error_y,
                       0.0};
  measured.heading = normalize_angle(truth.heading() + localization_errors_.heading_bias(seconds) +
                                     localization_noise_.draw(config_.noise.localization_heading));
  measured.map_from_body = Eigen::AngleAxisd(measured.heading, Eigen::Vector3d::UnitZ());
  measured.angular_velocity_body.z() = localization_errors_.yaw_rate_scale() * yaw_rate_ +
                                       localization_errors_.yaw_rate_bias() +
                                       localization_noise_.draw(config_.noise.yaw_rate);
  const double velocity_x = velocity_noise_.draw(config_.noise.localization_velocity);
  const double velocity_y = velocity_noise_.draw(config_.noise.localization_velocity);
  measured.linear_velocity.head<2>() = speed_ * truth.forward() + Point2(velocity_x, velocity_y);
  return measured;
}

Chassis VehicleSimulation::measure_chassis() {
  Chassis measured;
  measured.stamp = Time(time_);
  // Wheel sensors tell no direction, the gear does: noise does not make a standing vehicle reverse.
  const double speed = std::abs(speed_scale_ * speed_ + chassis_noise_.draw(config_.noise.chassis_speed));
  measured.speed = speed_ < 0.0 ? -speed : speed;
  return measured;
}

LaneMarker VehicleSimulation::measure_marker(const PaintLine& line, double view_range) const {
  LaneMarker marker;
  if (!line.painted) return marker;
  const MarkerErrorParam& errors = config_.errors.markers;
  const double min_radius = config_.paint.min_radius;
  const Sight sight{view_range, config_.paint.max_turn, errors.nearest,
                    min_radius > 0.0 ? 1.0 / min_radius : std::numeric_limits<double>::infinity()};
  // Where the camera really is and looks, which is not where it is taken to be.
  const Pose2 base(pose_.to_parent(Point2(0.0, errors.lateral)), pose_.heading() + errors.yaw);
  const FittedPaint paint =
      fit_paint(visible_paint(path_, s_, vertex_, line, base, sight), config_.paint.max_residual);
  if (paint.range < errors.nearest + kMinVisiblePaint) return marker;
  marker.longitude_start = errors.nearest;
  marker.type = line.type;
  marker.quality = config_.paint.quality;
  marker.cubic = paint.cubic;
  marker.view_range = std::min(view_range, paint.range);
  return marker;
}

LaneMarkers VehicleSimulation::measure_lane_markers() {
  LaneMarkers measured;
  measured.stamp = Time(time_);
  const double seconds = to_seconds(time_);
  const double view_range = marker_errors_.view_range(config_.paint.view_range, seconds);
  const std::vector<PaintLine>& lines = config_.paint.lines;
  const auto right = static_cast<std::size_t>(std::distance(
      lines.begin(),
      std::find_if(lines.begin(), lines.end(), [&](const PaintLine& line) { return line.l_at(s_) <= l_; })));
  if (right > 0) measured.left = measure_marker(lines[right - 1], view_range);
  if (right < lines.size()) measured.right = measure_marker(lines[right], view_range);
  if (right > 1) measured.next_left.push_back(measure_marker(lines[right - 2], view_range));
  if (right + 1 < lines.size()) measured.next_right.push_back(measure_marker(lines[right + 1], view_range));
  marker_errors_.spoil(measured, seconds);
  marker_latency_ = from_seconds(marker_errors_.draw_latency());
  return measured;
}

}  // namespace relative_map::core
