#pragma once

#include <set>
#include <vector>

#include "relative_map/model/route.hpp"
#include "relative_map/route/lane_network.hpp"
#include "relative_map/route/route_line.hpp"

namespace relative_map::core {

/// What is driven of one lane, and how it is left.
struct WayStep {
  LanePiece piece;
  ChangeLane leave = ChangeLane::kForward;  ///< forward: at its end, to a successor
};

/// A way of least cost, lane by lane.
using Way = std::vector<WayStep>;

/// Whether a vehicle may change from a lane to the side, by the lanes' types and the paint between them.
bool may_change(const LaneNetwork& network, std::size_t from, std::size_t to, ChangeLane side);

/// Only the lanes that a way starts and ends on are cut: those that it changes to or from there are made
/// whole.
void widen(const LaneNetwork& network, Way& way);
/// Puts a leg behind another at a way point.
void join(Way& way, const Way& leg);

/// The roads of a way: a stretch with lane changes in it is one road with a passage for each lane row, as
/// long as the rows run side by side; every other lane is a road of its own. No row is made longer over a
/// closed lane.
std::vector<RouteRoad> roads_of(const LaneNetwork& network, const Way& way,
                                const std::set<std::size_t>& closed);

}  // namespace relative_map::core
