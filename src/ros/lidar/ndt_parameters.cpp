#include "relative_map/ros/lidar/ndt_parameters.hpp"

#include "relative_map/ros/setup/parameter_taker.hpp"

namespace relative_map {

NdtNodeConfig make_ndt_config(const ParameterSet& parameters) {
  NdtNodeConfig config;
  ParameterTaker taker(parameters);
  const auto number = [&](const std::string& name, double& value, double low, double high) {
    taker.take(name, value);
    taker.expect(name, value, low, high);
  };
  taker.take("map", config.map);
  if (config.map.empty())
    taker.faults.push_back("map must name the folder of an NDT map (see build_ndt_map)");
  taker.take("base_frame", config.base_frame);
  if (config.base_frame.empty()) taker.faults.push_back("base_frame must not be empty");
  number("max_age/odometry", config.max_age_odometry, 0.01, 10.0);
  number("max_age/own_motion", config.max_gap, 0.01, 10.0);
  number("points/near", config.near, 0.0, 100.0);
  number("points/far", config.far, 1.0, 1000.0);
  number("points/leaf", config.leaf, 0.1, 10.0);
  number("map_window/radius", config.map_radius, 20.0, 2000.0);
  number("map_window/reload_distance", config.map_reload, 1.0, 500.0);
  number("map_window/memory", config.map_memory, 10.0, 1e5);
  number("start_radius", config.start_radius, 0.5, 30.0);
  number("refusals", config.refusals, 1.0, 1000.0);
  number("belief/min_likelihood", config.belief.min_likelihood, 0.0, 1.0);
  number("belief/upright_share", config.belief.upright_share, 0.0, 10.0);
  number("belief/min_overlap", config.belief.min_overlap, 0.0, 1.0);
  number("belief/max_correction", config.belief.max_correction, 0.1, 100.0);
  number("belief/max_turn", config.belief.max_turn, 0.01, 3.2);
  number("belief/weak_share", config.belief.weak_share, 0.0, 1.0);
  number("belief/weak_stddev", config.belief.weak_stddev, 0.1, 1e4);
  number("belief/min_translation_stddev", config.belief.min_translation_stddev, 1e-4, 10.0);
  number("belief/min_rotation_stddev", config.belief.min_rotation_stddev, 1e-5, 1.0);
  taker.take("match/coarse_start", config.match.coarse_start);
  if (config.near >= config.far) taker.faults.push_back("points/near must be less than points/far");
  taker.finish();
  return config;
}

}  // namespace relative_map
