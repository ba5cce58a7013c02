#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/LaneChange.h>
#include <relative_map/LaneGraph.h>
#include <relative_map/Route.h>
#include <relative_map/RouteSegmentsArray.h>

#include <string>
#include <vector>

#include "relative_map/model/lane_graph.hpp"
#include "relative_map/model/route.hpp"
#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/lane_change.hpp"
#include "relative_map/route/reference_line.hpp"

namespace relative_map {

core::LaneGraph to_core(const LaneGraph& message);
LaneGraph to_message(const core::LaneGraph& graph);

core::Route to_core(const Route& message);
Route to_message(const core::Route& route);

/// Place and segments, each with its line where there is one; lines are in the order of the segments. Header,
/// sequence number and route id are the caller's.
RouteSegmentsArrayPtr to_message(const core::RouteUpdate& update,
                                 const std::vector<core::ReferenceLine>& lines);

/// The line of one passage for what knows no route: poses along it.
nav_msgs::Path to_path(const RouteSegments& segments, const std_msgs::Header& header);

LaneChange to_message(const core::LaneChangeStatus& status);
/// "to lane 'a1': done" and such.
std::string sentence_of(const core::LaneChangeStatus& status);

/// Name of a status code as in RouteStatus.
std::string route_status_name(core::RouteCode code);

}  // namespace relative_map
