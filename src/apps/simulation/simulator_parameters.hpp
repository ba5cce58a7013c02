#pragma once

#include <ros/node_handle.h>

#include <string>
#include <vector>

#include "relative_map/simulation/vehicle_simulation.hpp"

namespace relative_map {

/// All that the vehicle simulator can be told.
struct SimulatorParameters {
  core::VehicleSimulationConfig simulation;
  std::vector<core::RecordedLine> lines;  ///< as read from the files, priorities in their order
  std::size_t drive_line = 0;             ///< index of the line to drive along
  std::string map_frame = "map";
  std::string base_frame = "base_link";
  double localization_rate = 100.0;  ///< [Hz]
  double chassis_rate = 100.0;       ///< [Hz]
  double lane_marker_rate = 15.0;    ///< [Hz]
  bool publish_navigation = true;
  bool publish_tf = true;    ///< false: another node says where the vehicle is
  bool repeat = false;       ///< at the end of an open line, start again
  bool exit_at_end = false;  ///< at the end of an open line, exit
};

/// Reads the node's private parameters and the navigation lines they name. Throws std::runtime_error with
/// all faults of the parameters and files: bad values, wrong types, unknown names.
SimulatorParameters read_simulator_parameters(const ros::NodeHandle& private_nh);

}  // namespace relative_map
