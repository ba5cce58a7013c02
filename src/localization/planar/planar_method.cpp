#include "relative_map/localization/planar/planar_method.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

using namespace planar;

PoseEstimate make_estimate(const PlanarState& state, const LocalizerParam& param, const MapProjection& map) {
  PoseEstimate estimate;
  estimate.stamp = state.time;
  if (!state.running) {
    estimate.message = "aligning: heading is not known yet";
    if (!state.memory || !state.memory->fix || state.memory->fix->first != state.time) return estimate;
    const PositionFix& fix = state.memory->fix->second;
    const MapPlace place = map.to_map(fix.place);
    estimate.position = place.position;
    estimate.position_covariance = place.map_from_local * fix.covariance * place.map_from_local.transpose() +
                                   param.inertial.antenna.squaredNorm() * Eigen::Matrix3d::Identity();
    return estimate;
  }
  const auto& x = state.filter.state();
  const auto& p = state.filter.covariance();
  const Eigen::Vector3d position(x(kX), x(kY), state.height - param.inertial.antenna.z());
  const MapPlace place = map.to_map(state.plane.to_earth(position));
  const Eigen::Matrix3d map_from_local = place.map_from_local;
  const Eigen::Matrix3d attitude =
      map_from_local * Eigen::AngleAxisd(x(kYaw), Eigen::Vector3d::UnitZ()).toRotationMatrix();
  const Eigen::Vector3d ahead(std::cos(x(kYaw)), std::sin(x(kYaw)), 0.0);
  estimate.position = place.position;
  estimate.map_from_body = Eigen::Quaterniond(attitude).normalized();
  estimate.heading = std::atan2(attitude(1, 0), attitude(0, 0));
  estimate.velocity = place.scale * map_from_local * (x(kSpeed) * ahead);
  estimate.rate_body << kNotGiven, kNotGiven, x(kYawRate);
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.topLeftCorner<2, 2>() =
      p.topLeftCorner<2, 2>() + state.of(Sensor::kFix).systematic * Eigen::Matrix2d::Identity();
  covariance(2, 2) = state.height_stddev * state.height_stddev;
  estimate.position_covariance = map_from_local * covariance * map_from_local.transpose();
  constexpr double kGround = 0.05;  // [rad] of a road's slope and bank, which are not seen
  estimate.attitude_covariance =
      Eigen::Vector3d(kGround * kGround, kGround * kGround, p(kYaw, kYaw)).asDiagonal();
  covariance = p(kSpeed, kSpeed) * ahead * ahead.transpose();
  const Eigen::Vector3d left(-ahead.y(), ahead.x(), 0.0);
  covariance += x(kSpeed) * x(kSpeed) * p(kYaw, kYaw) * left * left.transpose();
  covariance(2, 2) = x(kSpeed) * x(kSpeed) * kGround * kGround;
  estimate.velocity_covariance = map_from_local * covariance * map_from_local.transpose();

  const double stddev = estimate.horizontal_stddev(), yaw_stddev = std::sqrt(p(kYaw, kYaw));
  const bool steady = state.time >= state.steady_until && yaw_stddev <= param.inertial.max_yaw_stddev;
  estimate.code = stddev <= param.inertial.ok_stddev && steady ? EstimateCode::kOk
                  : stddev <= param.inertial.warning_stddev    ? EstimateCode::kWarning
                                                               : EstimateCode::kError;
  std::ostringstream text;
  text.precision(2);
  text << std::fixed << "the place is known to " << stddev << " m, the heading to "
       << yaw_stddev * 180.0 / M_PI << " degrees; last fix used "
       << to_seconds(state.time - state.last_absolute) << " s and " << state.distance << " m ago";
  estimate.message = text.str();
  return estimate;
}

PlanarMethod::PlanarMethod(const LocalizerParam& param)
    : history_(PlanarFilter(param), PlanarState(), from_seconds(2.0), Duration(0)) {}

Taken PlanarMethod::add(const Event& event) {
  return event.source == Sensor::kImu ? Taken::kTaken : history_.add(event);
}

std::optional<PoseEstimate> PlanarMethod::estimate(const MapProjection& map) {
  const PlanarState& state = history_.state();
  const double rate = history_.filter().param().rate;
  if (told_any_ && to_seconds(state.time - told_) < (state.running ? 0.9 / rate : 1e-9)) return std::nullopt;
  const PoseEstimate estimate = make_estimate(state, history_.filter().param(), map);
  if (!estimate.position.allFinite()) return std::nullopt;
  told_ = state.time;
  told_any_ = true;
  return estimate;
}

LocalizerReport PlanarMethod::report() const {
  const PlanarState& state = history_.state();
  LocalizerReport report;
  report.health = state.health;
  report.aligned = state.running;
  report.inflations = state.inflations;
  report.alignments = state.alignments;
  if (state.alignments == 0) return report;
  report.wheel_scale = state.filter.state()(kScale);
  report.since_fix = to_seconds(state.time - state.last_absolute);
  report.distance = state.distance;
  return report;
}

}  // namespace relative_map::core
