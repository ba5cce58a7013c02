#pragma once

#include <relative_map/ADCTrajectory.h>
#include <relative_map/MapMsg.h>
#include <relative_map/PerceptionObstacles.h>
#include <relative_map/PredictionObstacles.h>

#include "relative_map/model/road_users.hpp"
#include "relative_map/model/traffic_lanes.hpp"

namespace relative_map {

/// A planar frame in its parent.
using core::Pose2;

/// What was seen, in the map frame: `map_from_frame` is the place of the message's frame.
core::SeenRoadUsers to_core(const PerceptionObstacles& message, const Pose2& map_from_frame,
                            core::Time stamp);

/// The lanes of a relative map, in the map frame.
core::TrafficLanes to_traffic_lanes(const MapMsg& message, const Pose2& map_from_base);

/// The vehicle's plan, in the map frame, its times counted from `now`.
std::vector<core::TrajectoryPoint> to_core(const ADCTrajectory& message, const Pose2& map_from_frame,
                                           core::Time now);

/// In the frame whose place in the map frame is given; header and status are the caller's.
PredictionObstaclesPtr to_message(const core::Prediction& prediction, const Pose2& map_from_frame);

/// A prediction read back, for checking.
core::Prediction to_core(const PredictionObstacles& message);

}  // namespace relative_map
