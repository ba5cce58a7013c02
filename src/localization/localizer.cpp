#include "relative_map/localization/localizer.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/geometry/angles.hpp"
#include "relative_map/localization/inertial_filter/inertial_method.hpp"
#include "relative_map/localization/planar/planar_method.hpp"
#include "relative_map/localization/rtk/rtk_method.hpp"

namespace relative_map::core {

namespace {

constexpr double kMaxRate = 35.0;       // [rad/s] 2000 degrees a second, the widest range that is sold
constexpr double kMaxForce = 200.0;     // [m/s^2] 20 g
constexpr double kMaxSpeed = 120.0;     // [m/s]
constexpr double kLeastStddev = 0.005;  // [m] no fix is better
constexpr double kNoAltitude = 1e4;     // [m] standard deviation of one that is not given

/// [m] a receiver's error where it does not tell, by what it corrects with; on the cautious side.
double usual_stddev(int status) {
  return status >= 2 ? 0.5 : status == 1 ? 2.0 : 4.0;
}

std::unique_ptr<LocalizationMethod> make_method(const LocalizerParam& param) {
  if (param.method == Method::kRtk) return std::make_unique<RtkMethod>(param);
  if (param.method == Method::kPlanar) return std::make_unique<PlanarMethod>(param);
  return std::make_unique<InertialMethod>(param.inertial, param.rate);
}

}  // namespace

std::vector<std::string> LocalizerParam::validate() const {
  std::vector<std::string> faults = inertial.validate();
  if (!(rate > 0.0 && rate <= 1000.0)) faults.push_back("rate must be above 0 and at most 1000 Hz");
  for (const double offset : {stamp_offset.imu, stamp_offset.fix, stamp_offset.fix_velocity,
                              stamp_offset.heading, stamp_offset.wheels, stamp_offset.map_pose}) {
    if (!(std::abs(offset) <= 1.0)) faults.push_back("stamp_offset: each must be within 1 s");
  }
  if (!(assumed.fix >= 0.0 && assumed.fix <= 100.0)) faults.push_back("fix_stddev must be 0 to 100 m");
  if (!(assumed.fix_velocity > 0.0 && assumed.fix_velocity <= 100.0)) {
    faults.push_back("fix_velocity_stddev must be above 0 and at most 100 m/s");
  }
  if (!(assumed.heading > 0.0 && assumed.heading <= 3.0)) {
    faults.push_back("heading_stddev must be above 0 and at most 3 rad");
  }
  const auto expect_positive = [&faults](const char* name, double value) {
    if (!(value > 0.0 && value <= 1000.0))
      faults.push_back(std::string(name) + " must be above 0 and at most 1000");
  };
  expect_positive("planar/acceleration", planar.acceleration);
  expect_positive("planar/yaw_acceleration", planar.yaw_acceleration);
  expect_positive("planar/yaw_rate_stddev", planar.yaw_rate_stddev);
  expect_positive("planar/yaw_rate_bias", planar.yaw_rate_bias);
  expect_positive("planar/slip", planar.slip);
  expect_positive("rtk/max_wait", rtk.max_wait);
  expect_positive("rtk/max_bracket", rtk.max_bracket);
  expect_positive("rtk/course_speed", rtk.course_speed);
  expect_positive("rtk/ok_stddev", rtk.ok_stddev);
  expect_positive("rtk/warning_stddev", rtk.warning_stddev);
  return faults;
}

Localizer::Localizer(const LocalizerParam& param) : param_(param) {
  if (param_.reference.projection != Projection::kNone) map_.emplace(param_.reference);
  reset();
}

Localizer::~Localizer() = default;

void Localizer::reset() {
  method_ = make_method(param_);
  estimated_ = false;
}

void Localizer::set_imu_place(const Eigen::Vector3d& place) {
  if (place == param_.inertial.imu) return;
  param_.inertial.imu = place;
  reset();
}

void Localizer::set_antenna_place(const Eigen::Vector3d& place) {
  if (place == param_.inertial.antenna) return;
  param_.inertial.antenna = place;
  reset();
}

void Localizer::set_reference(const GeoReference& reference) {
  map_.emplace(reference);
}

bool Localizer::is_finite(const char* name, bool finite) {
  if (!finite) remark(std::string(name) + ": a number is not finite; it is dropped");
  return finite;
}

void Localizer::add(Event event, double stamp_offset, const char* name) {
  event.stamp += from_seconds(stamp_offset);
  switch (stamps_.judge(event.stamp)) {
    case StampGuard::Verdict::kStray:
      remark(std::string(name) + ": a stamp lies far from those of the others; it is dropped");
      return;
    case StampGuard::Verdict::kRestart:
      remark(std::string(name) + ": the stamps have jumped for good: starting anew");
      reset();
      break;
    case StampGuard::Verdict::kGood:
      break;
  }
  switch (method_->add(event)) {
    case Taken::kTwice:
      remark(std::string(name) + ": two messages have one stamp; the second is dropped");
      return;
    case Taken::kTooOld:
      remark(std::string(name) + ": a message came more than 2 s late; it is dropped");
      return;
    case Taken::kTaken:
      break;
  }
  if (!map_) return;
  while (auto estimate = method_->estimate(*map_)) {
    if (estimated_ && estimate->stamp <= newest_) continue;
    newest_ = estimate->stamp;
    estimated_ = true;
    estimates_.push_back(std::move(*estimate));
  }
}

void Localizer::add_imu(Time stamp, const ImuSample& sample) {
  if (!is_finite("imu", sample.angular_velocity.allFinite() && sample.specific_force.allFinite())) return;
  if (sample.angular_velocity.norm() > kMaxRate) {
    return remark("imu: an angular velocity is beyond any sensor's range: is it in degrees? It is dropped");
  }
  if (sample.specific_force.norm() > kMaxForce) {
    return remark("imu: a linear acceleration is beyond 20 g; it is dropped");
  }
  add({stamp, Sensor::kImu, sample}, param_.stamp_offset.imu, "imu");
}

void Localizer::add_fix(Time stamp, const FixReading& reading) {
  FixReading fix = reading;
  if (fix.status < 0) return remark("fix: the receiver has no fix (status -1)");
  if (!is_finite("fix", std::isfinite(fix.place.latitude) && std::isfinite(fix.place.longitude))) return;
  if (fix.place.latitude == 0.0 && fix.place.longitude == 0.0) {
    return remark("fix: latitude and longitude are both 0: nothing was measured; it is dropped");
  }
  if (std::abs(fix.place.latitude) > 90.0 || std::abs(fix.place.longitude) > 360.0) {
    return remark("fix: latitude or longitude is not on the earth; are they swapped? It is dropped");
  }
  if (map_) {
    if (const std::string refusal = map_->refusal(fix.place); !refusal.empty()) {
      return remark("fix: " + refusal + "; it is dropped");
    }
  }
  double stddev = param_.assumed.fix > 0.0 ? param_.assumed.fix : usual_stddev(fix.status);
  const bool usable = fix.covariance_known && fix.covariance.allFinite() &&
                      fix.covariance.diagonal().head<2>().minCoeff() > 0.0 &&
                      fix.covariance.diagonal().head<2>().maxCoeff() < 1e8;
  PositionFix position{fix.place, Eigen::Matrix3d::Zero(), fix.status >= 2};
  if (usable) {
    position.covariance = 0.5 * (fix.covariance + fix.covariance.transpose());
    // Correlations that can't be, and heights that are not told.
    if (!(position.covariance(2, 2) > 0.0)) position.covariance(2, 2) = 4.0 * position.covariance(0, 0);
    if (Eigen::LLT<Eigen::Matrix3d>(position.covariance).info() != Eigen::Success) {
      position.covariance = Eigen::Matrix3d(position.covariance.diagonal().asDiagonal());
    }
    position.covariance.diagonal() = position.covariance.diagonal().cwiseMax(kLeastStddev * kLeastStddev);
  } else {
    if (!(param_.assumed.fix > 0.0)) {
      remark("fix: its covariance is unknown or can't be: it is taken to be good to " +
             std::to_string(stddev) + " m");
    }
    position.covariance.diagonal() << stddev * stddev, stddev * stddev, 4.0 * stddev * stddev;
  }
  if (!std::isfinite(position.place.altitude)) {
    position.place.altitude = altitude_;
    position.covariance(2, 2) = kNoAltitude * kNoAltitude;
    position.covariance(0, 2) = position.covariance(2, 0) = 0.0;
    position.covariance(1, 2) = position.covariance(2, 1) = 0.0;
  } else {
    altitude_ = position.place.altitude;
  }
  if (!map_) {
    map_.emplace(param_.local_at_first_fix
                     ? GeoReference{Projection::kLocal, 0, true, position.place.latitude,
                                    position.place.longitude, position.place.altitude}
                     : MapProjection::zone_at(position.place));
  }
  add({stamp, Sensor::kFix, position}, param_.stamp_offset.fix, "fix");
}

void Localizer::add_fix_velocity(Time stamp, const Eigen::Vector3d& given, double stddev) {
  Eigen::Vector3d velocity = given;
  if (!is_finite("fix_velocity", velocity.head<2>().allFinite())) return;
  if (velocity.head<2>().norm() > kMaxSpeed) {
    return remark("fix_velocity: it is faster than 120 m/s; it is dropped");
  }
  if (!(stddev > 0.0)) stddev = param_.assumed.fix_velocity;
  VelocityFix fix{velocity, Eigen::Matrix3d::Identity() * stddev * stddev};
  fix.covariance(2, 2) *= 4.0;  // satellites are above only
  if (!std::isfinite(velocity.z())) {
    fix.velocity.z() = 0.0;
    fix.covariance(2, 2) = 100.0;
  }
  add({stamp, Sensor::kFixVelocity, fix}, param_.stamp_offset.fix_velocity, "fix_velocity");
}

void Localizer::add_heading(Time stamp, double heading, double stddev) {
  if (!is_finite("heading", std::isfinite(heading))) return;
  if (!(stddev > 0.0)) stddev = param_.assumed.heading;
  add({stamp, Sensor::kHeading, HeadingFix{normalize_angle(heading), stddev}}, param_.stamp_offset.heading,
      "heading");
}

void Localizer::add_wheels(Time stamp, const WheelSpeed& wheels) {
  if (!is_finite("wheels", std::isfinite(wheels.speed))) return;
  if (std::abs(wheels.speed) > kMaxSpeed) {
    return remark("wheels: the speed is beyond 120 m/s: is it in km/h? It is dropped");
  }
  add({stamp, Sensor::kWheels, wheels}, param_.stamp_offset.wheels, "wheels");
}

void Localizer::add_map_pose(Time stamp, const MapPoseReading& pose) {
  if (!is_finite("map_pose", pose.position.allFinite() && pose.map_from_body.coeffs().allFinite() &&
                                 pose.position_covariance.allFinite())) {
    return;
  }
  if (!map_)
    return remark(
        "map_pose: where the map lies on the earth is not known before a fix, or a projection "
        "that is set; it is dropped");
  if (!(pose.position_covariance.diagonal().minCoeff() > 0.0) ||
      Eigen::LLT<Eigen::Matrix3d>(pose.position_covariance).info() != Eigen::Success) {
    return remark("map_pose: its covariance is not given; it is dropped");
  }
  const GeoPoint place = map_->to_earth(pose.position);
  const MapPlace here = map_->to_map(place);
  const Eigen::Matrix3d local_from_map = here.map_from_local.transpose();
  const Eigen::Matrix3d covariance = local_from_map * pose.position_covariance * here.map_from_local;
  add({stamp, Sensor::kMapPosition, PositionFix{place, covariance, false}}, param_.stamp_offset.map_pose,
      "map_pose");
  if (!(pose.yaw_variance > 0.0)) return;
  const Eigen::Vector3d ahead = local_from_map * (pose.map_from_body.normalized() * Eigen::Vector3d::UnitX());
  add({stamp, Sensor::kMapHeading,
       HeadingFix{std::atan2(ahead.y(), ahead.x()), std::sqrt(pose.yaw_variance)}},
      param_.stamp_offset.map_pose, "map_pose");
}

std::vector<PoseEstimate> Localizer::take_estimates() {
  return std::exchange(estimates_, {});
}

std::vector<std::string> Localizer::take_remarks() {
  return std::exchange(remarks_, {});
}

LocalizerReport Localizer::report() const {
  return method_->report();
}

}  // namespace relative_map::core
