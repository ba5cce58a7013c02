#pragma once

#include <Eigen/Core>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/prediction_config.hpp"
#include "relative_map/model/road_users.hpp"

namespace relative_map::core {

/// How an acceleration behaves: it fades to 1/e in `time` [s] and is stirred so that its standard deviation
/// stays `along` and `across` the heading [m/s^2] (R. A. Singer, 1970).
struct AccelerationModel {
  double time = 3.0, along = 1.0, across = 1.0;
};
AccelerationModel acceleration_model(RoadUserType type, const MotionFilterParam& param);

/// Position, velocity and acceleration after `dt` [s] of an axis whose acceleration fades.
Eigen::Matrix3d singer_transition(double dt, double time);
/// The covariance that unit acceleration noise adds meanwhile.
Eigen::Matrix3d singer_noise(double dt, double time);

/// A Kalman filter of x, y, vx, vy, ax, ay in the map frame [m, s]; measures positions and, where a sensor
/// has them, velocities.
class MotionFilter {
 public:
  using State = Eigen::Matrix<double, 6, 1>;
  using Covariance = Eigen::Matrix<double, 6, 6>;

  MotionFilter() = default;
  /// Where it was seen first. Its velocity is not known, unless it is given.
  MotionFilter(const SeenRoadUser& seen, double position_stddev, const MotionFilterParam& param);

  /// Carries on by `dt` [s] >= 0 of any size; `heading` [rad] is where "along" points.
  void predict(double dt, double heading, const AccelerationModel& model);
  /// `stddev` [m] on each axis.
  void update_position(const Point2& position, double stddev);
  void update_velocity(const Point2& velocity, double stddev);
  /// How unlikely a position is: squared, in standard deviations; 2 degrees of freedom.
  double surprise(const Point2& position, double stddev) const;

  Point2 position() const { return state_.segment<2>(0); }
  Point2 velocity() const { return state_.segment<2>(2); }
  Point2 acceleration() const { return state_.segment<2>(4); }
  const State& state() const { return state_; }
  const Covariance& covariance() const { return covariance_; }
  /// Standard deviation of the velocity along a unit vector [m/s].
  double speed_stddev(const Point2& direction) const;

 private:
  State state_ = State::Zero();
  Covariance covariance_ = Covariance::Identity();
  bool seed_ = false;
};

}  // namespace relative_map::core
