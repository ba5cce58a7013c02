#pragma once

#include <string>
#include <variant>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lanes/marker_path.hpp"

namespace relative_map::core {

/// The path between the markers, or why there is none.
/// Its cubic is the mean of both (c0 plain, c1 to c3 by quality); one marker alone is followed at the default
/// half width. Past view_range the curvature fades to zero, see `follow`.
/// `base_from_sensor`: the markers' frame, where it was at their stamp, as seen from base_link now.
std::variant<MarkerPath, std::string> make_marker_path(const LaneMarkers& markers,
                                                       const Pose2& base_from_sensor, double speed,
                                                       const MapParam& map_param,
                                                       const NavigationLaneParam& param);

}  // namespace relative_map::core
