#pragma once

#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lines/tracked_line.hpp"

namespace relative_map::core {

/// The part of a line around the vehicle, in the body frame: the line's own vertices from three before the
/// nearest one (on thinned lines at least 2 m before it) to the first one past `max_length` [m].
/// It ends at kinks, behind the vehicle as ahead, and counts what remains up to there.
/// Closed lines go on across the stitch, as often as the length needs. Half widths are left unset.
LanePath cut_window(const NavigationLine& line, const LineProjection& projection, const Pose2& map_from_base,
                    double max_length);

/// The windows of the lines, in their order, in the body frame.
std::vector<LanePath> cut_windows(const TrackedLines& lines, const VehicleState& vehicle,
                                  const PipelineConfig& config);

}  // namespace relative_map::core
