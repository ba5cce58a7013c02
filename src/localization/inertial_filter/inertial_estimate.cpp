#include "relative_map/localization/inertial_filter/inertial_estimate.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

using namespace error;

double PoseEstimate::horizontal_stddev() const {
  return std::sqrt(std::max(position_covariance(0, 0), position_covariance(1, 1)));
}

namespace {

/// How much of the stamp offset is the inertial sensor's: all, unless it is the fixes that are clearly late.
double share_of_imu(double offset, double stddev) {
  if (!(stddev > 0.0)) return offset > 0.0 ? 1.0 : 0.0;
  return std::clamp(1.5 + 0.5 * offset / stddev, 0.0, 1.0);  // 1 from -1, 0 below -3 standard deviations
}

void judge(const InertialState& state, const InertialParam& param, double yaw_stddev,
           PoseEstimate& estimate) {
  const double stddev = estimate.horizontal_stddev();
  std::ostringstream text;
  text.precision(2);
  estimate.code = stddev <= param.ok_stddev        ? EstimateCode::kOk
                  : stddev <= param.warning_stddev ? EstimateCode::kWarning
                                                   : EstimateCode::kError;
  const auto at_least = [&estimate](EstimateCode code) { estimate.code = std::max(estimate.code, code); };
  if (estimate.code != EstimateCode::kOk) text << "the place is known to " << stddev << " m only; ";
  if (!(yaw_stddev <= param.max_yaw_stddev)) {
    at_least(EstimateCode::kWarning);
    text << "the heading is known to " << yaw_stddev * 180.0 / M_PI << " degrees only; ";
  }
  if (state.time < state.steady_until) {
    at_least(EstimateCode::kWarning);
    text << "fixes disagreed with the filter, which was made less certain; ";
  }
  if (to_seconds(state.time - state.gap_end) < 1.0) {
    at_least(EstimateCode::kWarning);
    text << "the inertial sensor was silent for a while; ";
  }
  text.precision(1);
  text << std::fixed << "last fix used " << to_seconds(state.time - state.last_absolute) << " s and "
       << state.distance << " m ago";
  estimate.message = text.str();
}

}  // namespace

PoseEstimate make_estimate(const InertialState& state, const InertialParam& param, const MapProjection& map) {
  PoseEstimate estimate;
  estimate.stamp = state.time;
  if (state.mode != FilterMode::kRunning) {
    estimate.message = !state.has_imu                               ? "waiting for the inertial sensor"
                       : state.level == InertialState::Level::kNone ? "aligning: level is not known yet"
                                                                    : "aligning: heading is not known yet";
    if (!state.memory || !state.memory->fix) {
      estimate.message += "; no fix has come";
      return estimate;
    }
    const auto& [stamp, fix] = *state.memory->fix;
    if (to_seconds(state.time - stamp) > 0.05) return estimate;
    const MapPlace place = map.to_map(fix.place);
    estimate.position = place.position;
    // The antenna's: how it lies to the body is not known without a heading.
    estimate.position_covariance = place.map_from_local * fix.covariance * place.map_from_local.transpose() +
                                   param.antenna.squaredNorm() * Eigen::Matrix3d::Identity();
    return estimate;
  }
  const NavigationState& nav = state.nav;
  const ErrorCovariance& p = state.error.covariance();
  const double share =
      share_of_imu(nav.stamp_offset, std::sqrt(std::max(0.0, p(kStampOffset, kStampOffset))));
  estimate.stamp = state.time - from_seconds(share * nav.stamp_offset);

  const Eigen::Vector3d lever = -param.imu;
  const Eigen::Vector3d position = nav.position + nav.attitude * lever;
  const MapPlace place = map.to_map(state.plane.to_earth(position));
  const Eigen::Matrix3d map_from_plane = place.map_from_local * state.plane.local_from_plane(position);
  // The axle's axes, by what was found of the mount.
  Eigen::Matrix3d body_from_axle = (Eigen::AngleAxisd(nav.mount_yaw, Eigen::Vector3d::UnitZ()) *
                                    Eigen::AngleAxisd(nav.mount_pitch, Eigen::Vector3d::UnitY()))
                                       .toRotationMatrix();
  const Eigen::Matrix3d attitude = map_from_plane * nav.attitude * body_from_axle;
  const Eigen::Vector3d velocity = nav.velocity + nav.attitude * state.motion.rate.cross(lever);

  estimate.position = place.position;
  estimate.map_from_body = Eigen::Quaterniond(attitude).normalized();
  estimate.heading = std::atan2(attitude(1, 0), attitude(0, 0));
  estimate.velocity = place.scale * map_from_plane * velocity;
  estimate.rate_body = body_from_axle.transpose() * state.motion.rate;
  estimate.acceleration_body = body_from_axle.transpose() * (state.sample.specific_force - nav.accel_bias +
                                                             nav.attitude.transpose() * state.earth.gravity);

  Eigen::Matrix<double, 3, kCount> h = Eigen::Matrix<double, 3, kCount>::Zero();
  h.middleCols<3>(kPosition) = map_from_plane;
  h.middleCols<3>(kAttitude) = -map_from_plane * nav.attitude * cross_matrix(lever);
  h.col(kStampOffset) = share * map_from_plane * velocity;
  estimate.position_covariance =
      h * p * h.transpose() + state.of(Sensor::kFix).systematic * Eigen::Matrix3d::Identity();
  h.setZero();
  h.middleCols<3>(kVelocity) = map_from_plane;
  h.col(kStampOffset) = share * map_from_plane * state.motion.acceleration;
  estimate.velocity_covariance = h * p * h.transpose();
  h.setZero();
  h.middleCols<3>(kAttitude) = map_from_plane * nav.attitude;
  h.col(kMountPitch) = map_from_plane * nav.attitude.col(1);
  h.col(kMountYaw) = map_from_plane * nav.attitude.col(2);
  h.col(kStampOffset) = share * map_from_plane * nav.attitude * state.motion.rate;
  estimate.attitude_covariance = h * p * h.transpose();
  judge(state, param, std::sqrt(estimate.attitude_covariance(2, 2)), estimate);
  return estimate;
}

}  // namespace relative_map::core
