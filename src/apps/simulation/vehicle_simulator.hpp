#pragma once

#include <relative_map/LaneMarkers.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>
#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>

#include <array>
#include <deque>
#include <optional>

#include "relative_map/simulation/vehicle_simulation.hpp"
#include "simulator_parameters.hpp"

namespace relative_map {

/// Topics and the clock around the simulated vehicle. Its sensors fall due at fixed times since the start, so
/// that a seed gives the same measurements however busy the machine is.
class VehicleSimulator {
 public:
  /// Throws std::invalid_argument if the line can't be driven along.
  VehicleSimulator(ros::NodeHandle nh, SimulatorParameters parameters);

  /// Drives until ROS shuts down, or the end of the line if the simulator is to exit there.
  void run();

 private:
  struct Sensor {
    core::Duration period;
    void (VehicleSimulator::*publish)();
    core::Duration due{};  ///< since the start
  };
  struct LateMarkers {
    core::Duration due;  ///< since the start
    LaneMarkers message;
  };

  void publish_navigation();
  void publish_localization();
  void publish_truth();
  void publish_chassis();
  void take_image();
  void publish_lane_markers(core::Duration until);
  void broadcast(const core::Localization& localization);
  Sensor& next_sensor();
  void wait_until(core::Duration due);
  bool finished();
  ros::Time stamp() const;

  SimulatorParameters parameters_;
  core::VehicleSimulation vehicle_;
  std::array<Sensor, 3> sensors_;
  std::deque<LateMarkers> late_markers_;      ///< by rising time: of images that are still looked at
  core::Time start_{};                        ///< when the vehicle's time was 0
  std::optional<core::Duration> stopped_at_;  ///< when it came to the end of the line
  ros::Publisher navigation_publisher_, localization_publisher_, chassis_publisher_, lane_markers_publisher_,
      truth_publisher_;
  tf2_ros::TransformBroadcaster broadcaster_;
  tf2_ros::StaticTransformBroadcaster static_broadcaster_;
};

}  // namespace relative_map
