#pragma once

#include <deque>

#include "relative_map/localization/imu/imu_buffer.hpp"
#include "relative_map/localization/localizer.hpp"

namespace relative_map::core {

/// What is known at the time of a fix, in any east-north-up frame. NaN or none: not given.
struct RtkReading {
  Eigen::Vector3d antenna = Eigen::Vector3d::Zero();                        ///< [m]
  Eigen::Vector3d antenna_velocity = Eigen::Vector3d::Constant(kNotGiven);  ///< [m/s]
  std::optional<Eigen::Quaterniond> attitude;                               ///< from the body (FLU)
  std::optional<Eigen::Vector3d> rate;                                      ///< [rad/s] body
  std::optional<Eigen::Vector3d> acceleration;  ///< [m/s^2] body, gravity taken out
};

/// The body's pose and motion from the antenna's, `lever` [m] being the antenna's place in the body. Gives
/// what can be given: place without attitude is the antenna's. Header, covariances and status are the
/// caller's.
PoseEstimate compose_rtk(const RtkReading& reading, const Eigen::Vector3d& lever);

/// A pose for each fix, of what the sensors say at its time; nothing is filtered, nothing is extrapolated,
/// and what is missing is NaN with the reason in the status. The heading is the dual antenna's, else the
/// course (at course_speed or more), carried on by the gyro while it is slower.
class RtkMethod : public LocalizationMethod {
 public:
  explicit RtkMethod(const LocalizerParam& param) : param_(param) {}
  Taken add(const Event& event) override;
  std::optional<PoseEstimate> estimate(const MapProjection& map) override;
  LocalizerReport report() const override { return report_; }

 private:
  struct Heading {
    double yaw = kNotGiven, stddev = kNotGiven;  ///< [rad]
    bool known() const { return std::isfinite(yaw); }
  };
  Heading heading_at(Time time, const VelocityFix* velocity);
  const Event* nearest(Sensor source, Time time, double within) const;
  void carry(const Event& imu);
  PoseEstimate make(const PositionFix& fix, Time stamp, const MapProjection& map);

  LocalizerParam param_;
  ImuBuffer imu_;
  std::deque<Event> recent_;   ///< of all sources but the inertial sensor, two seconds, in order of stamps
  std::deque<Event> waiting_;  ///< fixes
  Heading course_;             ///< carried by the gyro
  Time course_time_{}, last_fix_{}, newest_{};
  bool any_fix_ = false, any_ = false;
  LocalizerReport report_;
};

}  // namespace relative_map::core
