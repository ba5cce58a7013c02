#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "relative_map/localization/localizer_param.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

/// All that the localizer can be told. Defaults as in config/localization.yaml.
struct LocalizerNodeConfig {
  core::LocalizerParam localizer;
  std::string map_frame = "map", base_frame = "base_link";
  std::optional<Eigen::Isometry3d> base_from_imu;    ///< in place of tf's
  std::optional<Eigen::Vector3d> base_from_antenna;  ///< [m] likewise
  bool publish_tf = false;                           ///< map -> base_link
  double max_age_imu = 0.1, max_age_fix = 1.0;       ///< [s] older: it is told
};

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
LocalizerNodeConfig make_localizer_config(const ParameterSet& parameters);

}  // namespace relative_map
