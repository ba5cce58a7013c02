#pragma once

#include <string>

#include "relative_map/localization/ndt/ndt_param.hpp"
#include "relative_map/ros/setup/parameters.hpp"

namespace relative_map {

/// All that the NDT localizer can be told. Defaults as in config/ndt_localizer.yaml.
struct NdtNodeConfig {
  std::string map;  ///< folder of an NDT map
  std::string base_frame = "base_link";
  double max_age_odometry = 0.5;   ///< [s] older odometry is not what a cloud is expected by
  double max_gap = 1.0;            ///< [s] without odometry the own motion is carried on for so long
  double near = 1.0, far = 100.0;  ///< [m] points nearer to the sensor or farther are left out
  double leaf = 1.0;               ///< [m] of the voxel filter
  double map_radius = 150.0;       ///< [m] of the map around the vehicle
  double map_reload = 20.0;        ///< [m] of driving until the next part is loaded
  double map_memory = 500.0;       ///< [MB] of tiles
  double start_radius = 5.0;       ///< [m] of positions that a search for the place tries
  double refusals = 5.0;           ///< [-] in a row, and the place is lost
  core::NdtMatchParam match;
  core::NdtBeliefParam belief;
};

/// The configuration, or std::runtime_error whose text lists every unknown key, wrong type and bad value.
NdtNodeConfig make_ndt_config(const ParameterSet& parameters);

}  // namespace relative_map
