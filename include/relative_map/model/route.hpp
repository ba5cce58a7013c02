#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/geometry/pose2.hpp"

// A way over a lane graph. A route is a row of roads; a road is a row of passages side by side; a passage is
// a row of pieces of lanes, one after the other. All s are [m] along the lane's centerline.
namespace relative_map::core {

/// Which way a vehicle on a passage has to change lanes to go on along the route.
enum class ChangeLane : std::uint8_t { kForward = 0, kLeft = 1, kRight = 2 };

/// A piece of a lane.
struct LaneSegment {
  std::string lane_id;
  double start_s = 0.0;
  double end_s = 0.0;
};

struct Passage {
  std::vector<LaneSegment> segments;
  bool can_exit = false;  ///< it leads to the next road, on the last road to the destination
  ChangeLane change_lane = ChangeLane::kForward;  ///< the change that is needed where it does not
};

struct RouteRoad {
  std::string id;
  std::vector<Passage> passages;
};

/// A place that the route passes. The first is its start, the last its destination.
struct RouteWaypoint {
  std::string lane_id;
  double s = 0.0;
  std::optional<Point2> position;  ///< [m] in the graph's frame, where it is told
};

struct Route {
  std::string id;        ///< a name for people; no part of a route's identity
  std::string frame_id;  ///< empty: not told
  std::string map_version;
  std::vector<RouteRoad> roads;
  std::vector<RouteWaypoint> waypoints;
  double distance = 0.0;  ///< [m] along it, as the search told it
};

/// Whether two routes lead the same way: all but id, frame and distance.
bool same_way(const Route& a, const Route& b);

}  // namespace relative_map::core
