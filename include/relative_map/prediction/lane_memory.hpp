#pragma once

#include <map>
#include <string>

#include "relative_map/model/traffic_lanes.hpp"

namespace relative_map::core {

/// A relative map begins just behind the vehicle; those who follow it are on the lanes that it has passed.
/// This keeps them, in the map frame, by the lanes' ids.
class LaneMemory {
 public:
  /// `length` [m] of each lane that is kept behind where its window begins now.
  explicit LaneMemory(double length = 150.0) : length_(length) {}

  /// The lanes as they are seen now, each with what was passed of it. A lane that lies elsewhere than it did,
  /// by more than a lane estimate moves, has no past.
  TrafficLanes remember(TrafficLanes seen);
  void clear() { lines_.clear(); }

 private:
  double length_;
  std::map<std::string, Polyline> lines_;
};

}  // namespace relative_map::core
