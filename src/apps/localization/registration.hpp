#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "relative_map/localization/pyramid/pyramid_matcher.hpp"
#include "relative_map/model/point_cloud.hpp"

namespace relative_map {

/// What register_clouds is asked for. Defaults and units as in its help.
struct RegistrationRequest {
  bool pyramid = false;
  core::PyramidWeighing weighing = core::PyramidWeighing::kFusion;
  double resolution = 1.0;      ///< [m]
  double leaf = 0.5;            ///< [m]
  double nearest = 1.0;         ///< [m]
  double farthest = 100.0;      ///< [m]; 0: the target is a map, and whole
  double max_correction = 3.0;  ///< [m]
  int repeat = 1;
  Eigen::Isometry3d guess = Eigen::Isometry3d::Identity();
};

struct Registration {
  Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  double score = 0.0, likelihood = 0.0, upright_likelihood = 0.0, overlap = 0.0, condition = 0.0;
  int iterations = 0;
  double ms = 0.0, prepare_ms = 0.0, map_ms = 0.0;
  bool converged = false, believed = false;
  std::vector<std::string> reasons, remarks;
  std::size_t target_points = 0, source_points = 0;
};

/// Throws std::runtime_error as read_point_cloud(); says on standard error how many points were no points.
core::PointCloud read_cloud(const std::string& path);

/// x y z [m] roll pitch yaw [rad].
Eigen::Isometry3d pose_of(const std::vector<double>& numbers);

Registration register_clouds(const core::PointCloud& target, const core::PointCloud& source,
                             const RegistrationRequest& request);

/// [ms] of CPU time that this thread has used.
double cpu_ms();

}  // namespace relative_map
