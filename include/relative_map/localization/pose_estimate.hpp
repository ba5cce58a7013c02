#pragma once

#include <Eigen/Geometry>
#include <string>

#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

enum class EstimateCode { kOk, kWarning, kError };

/// Where the body (FLU, at the rear axle) is, and how it moves. NaN: not known. The map's axes are those of
/// its projection: in UTM, x is grid east.
struct PoseEstimate {
  Time stamp{};                                                     ///< that all of it holds for
  Eigen::Vector3d position = Eigen::Vector3d::Constant(kNotGiven);  ///< [m] map
  Eigen::Quaterniond map_from_body{kNotGiven, kNotGiven, kNotGiven, kNotGiven};
  double heading = kNotGiven;  ///< [rad] counter-clockwise from the map's x
  Eigen::Vector3d velocity = Eigen::Vector3d::Constant(kNotGiven);           ///< [m/s] map
  Eigen::Vector3d acceleration_body = Eigen::Vector3d::Constant(kNotGiven);  ///< [m/s^2] without gravity
  Eigen::Vector3d rate_body = Eigen::Vector3d::Constant(kNotGiven);          ///< [rad/s] without its bias
  // Covariances; of the attitude as a turn about the map's axes.
  Eigen::Matrix3d position_covariance = Eigen::Matrix3d::Constant(kNotGiven);  ///< [m^2]
  Eigen::Matrix3d attitude_covariance = Eigen::Matrix3d::Constant(kNotGiven);  ///< [rad^2]
  Eigen::Matrix3d velocity_covariance = Eigen::Matrix3d::Constant(kNotGiven);  ///< [m^2/s^2]
  EstimateCode code = EstimateCode::kError;
  std::string message;  ///< why it is not OK, and how long ago the place was seen last

  /// [m] the greater of those of x and y.
  double horizontal_stddev() const;
};

}  // namespace relative_map::core
