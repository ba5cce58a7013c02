#pragma once

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// The line that a simulated vehicle drives along.
struct DrivePath {
  Point2 origin = Point2::Zero();  ///< [m] map coordinates of the path's own origin
  PathPoints points;               ///< relative to `origin`; a lap ends with its first point again
  Ends ends = Ends::kOpen;

  /// [m] of the line, or of one lap.
  double length() const { return points.back().s; }
  /// s [m] within the path: a lap starts again, an open line ends.
  double hold(double s) const;
};

/// Closes the line to a lap where its ends meet, as the map does (see prepare_navigation_lines).
/// Throws std::invalid_argument with the reason if it can't be driven on.
DrivePath make_drive_path(const RecordedLine& line);

}  // namespace relative_map::core
