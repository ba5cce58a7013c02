#pragma once

#include <optional>
#include <string>
#include <variant>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lines/lane_path.hpp"

namespace relative_map::core {

/// The centerline between the vehicle's own lane markers, and what was seen of them.
struct MarkerPath {
  LanePath path;
  double trusted_from = 0.0;                            ///< [m] s of the path from which on paint was seen
  double trusted_to = 0.0;                              ///< [m] s of the path up to which paint was seen
  std::optional<BoundaryType> left_paint, right_paint;  ///< none: not seen
};

/// The path between the markers, or why there is none.
/// Its cubic is the mean of both (c0 plain, c1 to c3 by quality); one marker alone is followed at the default
/// half width. It is sampled at x = -2, -1, 0 ... in the markers' frame (from farther back, where that does
/// not reach back to the vehicle) up to a length proportional to `speed` [m/s]; past view_range the curvature
/// fades to zero. Paint that no vehicle could follow does not count.
/// `base_from_sensor`: the markers' frame, where it was at their stamp, as seen from base_link now.
std::variant<MarkerPath, std::string> make_marker_path(const LaneMarkers& markers,
                                                       const Pose2& base_from_sensor, double speed,
                                                       const MapParam& map_param,
                                                       const NavigationLaneParam& param);

/// The same along a centerline that was estimated from paint seen up to x = `seen_to` [m], in a frame that
/// lies in the body as `base_from_frame` says.
MarkerPath make_marker_path(const Cubic& centerline, const Pose2& base_from_frame, double seen_to,
                            double left_half_width, double right_half_width, double speed,
                            const NavigationLaneParam& param);

}  // namespace relative_map::core
