#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

/// Who drives there.
enum class LaneUse : std::uint8_t { kVehicles, kBicycles, kPedestrians, kParking };
enum class LaneTurn : std::uint8_t { kUnknown, kStraight, kLeft, kRight, kUTurn };

/// A lane as prediction needs it, in the map frame. What is not known stays empty or 0.
struct TrafficLane {
  std::string id;
  Polyline center;
  double left_width = 0.0, right_width = 0.0;  ///< [m] from the centerline, mean; 0: not known
  double speed_limit = 0.0;                    ///< [m/s]
  LaneUse use = LaneUse::kVehicles;
  LaneTurn turn = LaneTurn::kUnknown;
  bool in_junction = false;
  std::vector<std::string> successors, predecessors;
  std::string left_neighbor, right_neighbor;  ///< of the same direction
};

/// A place where roads meet.
struct JunctionArea {
  std::string id;
  Polyline border;          ///< closed without repeating its first point
  bool controlled = false;  ///< by signals or stop signs
};

struct TrafficLanes {
  std::vector<TrafficLane> lanes;
  std::vector<JunctionArea> junctions;
  std::string ego_lane;                  ///< the vehicle's own, if it is known
  std::vector<std::string> ego_targets;  ///< that its route follows
};

}  // namespace relative_map::core
