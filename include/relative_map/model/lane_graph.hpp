#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/map.hpp"

// A map of lanes: where they lie, and which follows which or lies beside which. In the map frame (ENU), or in
// the body frame where it was made from a relative map.
namespace relative_map::core {

/// Numbers of the message Lane.
enum class LaneType : std::uint8_t {
  kUnknown = 0,
  kNone = 1,
  kCityDriving = 2,
  kBiking = 3,
  kSidewalk = 4,
  kParking = 5,
  kShoulder = 6,
};

/// Numbers of the message Lane.
enum class LaneTurn : std::uint8_t {
  kUnknown = 0,
  kNoTurn = 1,
  kLeftTurn = 2,
  kRightTurn = 3,
  kUTurn = 4,
};

/// A lane; s runs along its centerline in the direction of travel, and is the chord length of its points.
struct GraphLane {
  std::string id;
  Polyline centerline;                               ///< [m] two or more points
  std::vector<WidthSample> left_width, right_width;  ///< half widths by s; empty: not known
  std::vector<std::string> successors, predecessors;
  std::vector<std::string> left_neighbors, right_neighbors;  ///< beside it, in the same direction
  std::vector<std::string> left_reverse, right_reverse;      ///< beside it, in the other direction
  std::vector<PaintSpan> left_paint, right_paint;            ///< by s; empty: no paint is known
  double speed_limit = 0.0;                                  ///< [m/s]; 0: not known
  LaneType type = LaneType::kCityDriving;
  LaneTurn turn = LaneTurn::kNoTurn;
  std::string road;      ///< the road that it is part of; may be empty
  std::string junction;  ///< the junction that it lies in; empty: none
};

struct LaneGraph {
  std::string frame_id;     ///< empty: not told
  std::string map_version;  ///< empty: not told
  std::vector<GraphLane> lanes;
};

}  // namespace relative_map::core
