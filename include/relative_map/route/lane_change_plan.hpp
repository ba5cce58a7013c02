#pragma once

#include <string>
#include <vector>

#include "relative_map/model/map.hpp"
#include "relative_map/route/lane_change.hpp"
#include "relative_map/route/route_map.hpp"
#include "relative_map/route/route_search.hpp"

namespace relative_map::core {

enum class LaneChangeGoal : std::uint8_t { kLeft = 0, kRight = 1, kLane = 2, kBack = 3 };

struct LaneChangeRequest {
  LaneChangeGoal to = LaneChangeGoal::kLeft;
  std::string lane_id;  ///< for kLane
  bool force = false;   ///< solid paint is crossed, too
};

/// How a lane change can be done, or why not.
struct LaneChangePlan {
  std::string why_not;  ///< one sentence; empty: it can
  std::vector<std::string> from,
      to;  ///< lanes one after the other that lie beside each other, from the vehicle on
  ChangeLane side = ChangeLane::kForward;
  Route route;  ///< over the target (its waypoint 1) to what was left of the way; on a relative map empty
};

/// A lane change to the left, to the right or to a lane beside, from where the vehicle is on its route. The
/// new way passes the target where the lane change must be done (param.needed() ahead), and then all
/// waypoints that were still to come. It is refused if there is no such lane; if the paint between is solid
/// (unless forced) or a curb; if the lanes lie beside each other for less than what is needed; if a waypoint
/// must be passed before; and if no way leads on from the target.
LaneChangePlan plan_lane_change(const RouteMap& map, RouteSearch& search, const RoutePlace& place,
                                double speed, const LaneChangeParam& param, const LaneChangeRequest& request);

/// The same on a relative map, from `own` lane; the route is its lanes.
LaneChangePlan plan_lane_change(const RelativeMap& map, const std::string& own, double speed,
                                const LaneChangeParam& param, const LaneChangeRequest& request);

}  // namespace relative_map::core
