#include "relative_map/localization/inertial_filter/inertial_method.hpp"

#include <cmath>

#include "relative_map/localization/inertial_filter/inertial_estimate.hpp"

namespace relative_map::core {

namespace {

constexpr double kHistory = 2.0;  // [s] that a measurement may come late
constexpr double kImuWait = 0.2;  // [s] a fix waits for an inertial sample; longer, and the sensor is silent

}  // namespace

InertialMethod::InertialMethod(const InertialParam& param, double rate)
    : history_(InertialFilter(param), InertialState(), from_seconds(kHistory), from_seconds(kImuWait)),
      rate_(rate) {}

Taken InertialMethod::add(const Event& event) {
  return history_.add(event);
}

std::optional<PoseEstimate> InertialMethod::estimate(const MapProjection& map) {
  const InertialState& state = history_.state();
  const bool aligning = state.mode != FilterMode::kRunning;
  // A little early is in time: the sensor's period is never exactly the one that was asked for.
  if (told_any_ && to_seconds(state.time - told_) < (aligning ? 1e-9 : 0.9 / rate_)) return std::nullopt;
  const PoseEstimate estimate = make_estimate(state, history_.filter().param(), map);
  if (!estimate.position.allFinite()) return std::nullopt;
  told_ = state.time;
  told_any_ = true;
  return estimate;
}

LocalizerReport InertialMethod::report() const {
  const InertialState& state = history_.state();
  LocalizerReport report;
  report.health = state.health;
  report.aligned = state.mode == FilterMode::kRunning;
  report.standing = state.standing;
  report.inflations = state.inflations;
  report.alignments = state.alignments;
  if (state.alignments == 0) return report;
  report.wheel_scale = state.nav.wheel_scale;
  report.mount_pitch = state.nav.mount_pitch;
  report.mount_yaw = state.nav.mount_yaw;
  report.stamp_offset = state.nav.stamp_offset;
  report.stamp_offset_stddev = state.error.stddev(error::kStampOffset);
  report.gyro_bias = state.nav.gyro_bias;
  report.accel_bias = state.nav.accel_bias;
  report.since_fix = to_seconds(state.time - state.last_absolute);
  report.distance = state.distance;
  return report;
}

}  // namespace relative_map::core
