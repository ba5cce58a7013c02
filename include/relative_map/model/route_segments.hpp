#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/route.hpp"

// What a planner is told of the route around the vehicle.
namespace relative_map::core {

/// Numbers of the message RouteStatus.
enum class RouteCode : std::uint8_t {
  kOk = 0,
  kNoGraph = 1,
  kNoRoute = 2,
  kUnknownLane = 3,
  kBadWaypoint = 4,
  kNoLocalization = 5,
  kStaleLocalization = 6,
  kOffRoute = 7,
  kWrongWay = 8,
  kRouteEnd = 9,
  kFrameMismatch = 10,
  kContractViolation = 11,
  kBadRoute = 12,
  kBadGraph = 13,
  kNoMap = 14,
  kStaleMap = 15,
};

struct RouteStatus {
  RouteCode code = RouteCode::kOk;
  std::string message;  ///< one sentence if the code is not OK
};

/// A lane and where along it.
struct LanePosition {
  std::string lane_id;
  double s = 0.0;  ///< [m]
};

/// Where a lane change has to be done.
struct ChangeZone {
  double begin = 0.0;  ///< [m] ahead of the vehicle: from here on the lane to change to lies beside
  double end = 0.0;    ///< [m] ahead of the vehicle: by here it must be done
};

/// One passage around the vehicle: what to follow, and what is to be done on it.
struct RouteSegments {
  std::string id;                                     ///< "road_passage", of this route
  std::vector<LaneSegment> segments;                  ///< in the order in which they are driven
  bool is_on_segment = false;                         ///< the vehicle is on it
  bool is_neighbor = false;                           ///< it is beside the vehicle
  ChangeLane next_action = ChangeLane::kForward;      ///< the change that leads from it on along the route
  ChangeLane previous_action = ChangeLane::kForward;  ///< the change that leads from the vehicle to it
  bool can_exit = false;
  /// No waypoint is left before the destination, and where its lane and s first come on these segments it is
  /// the destination, not an earlier pass of the same place.
  bool stop_for_destination = false;
  std::optional<LanePosition> route_end;  ///< the end of the passage, if it lies on these segments
  std::optional<ChangeZone> change;       ///< of the own passage, where next_action is a change
  std::uint32_t priority = 0;             ///< 0: to be driven on
  double s = 0.0;                         ///< [m] of the vehicle from the start of the segments
  double length() const;                  ///< [m]
};

/// Where the vehicle is on the route.
struct RoutePlace {
  std::string lane_id;
  double s = 0.0;           ///< [m] along the lane; past its ends where the vehicle is
  double l = 0.0;           ///< [m] left of the lane's centerline
  std::size_t segment = 0;  ///< of all segments of the route, in road, passage, place order
  std::size_t road = 0, passage = 0, position = 0;
  std::size_t next_waypoint = 0;         ///< of the route's waypoints; the last one where all are passed
  double distance_to_destination = 0.0;  ///< [m] along the route; negative past it
};

/// What a tick gives: segments, the own passage first, or a status that says why not.
struct RouteUpdate {
  RouteStatus status;
  std::optional<RoutePlace> place;
  std::vector<RouteSegments> segments;
};

}  // namespace relative_map::core
