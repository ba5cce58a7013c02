#pragma once

#include "relative_map/geometry/cubic.hpp"
#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/pose2.hpp"
#include "relative_map/simulation/drive_path.hpp"

namespace relative_map::core {

/// What a camera in the body frame sees of the paint that runs l [m] beside a path: a point each metre, from
/// the path's s [m] to the first one past `view_range` [m] in x, or to where the path ends or has turned so
/// far that a cubic in x no longer follows it. `base` is the body's pose in the path's frame.
Polyline visible_paint(const DrivePath& path, double s, double l, const Pose2& base, double view_range);

/// The cubic with the least squared distances in y from four or more points of rising x.
Cubic fit_cubic(const Polyline& points);

struct FittedPaint {
  Cubic cubic;
  double range = 0.0;  ///< [m] x up to which the cubic follows the paint; 0: too little is seen to fit one
};

/// Fits a cubic to as much of the paint as it can follow to 5 cm, from the near end on: a bend in which a
/// straight becomes a sharp curve is no cubic, and the near part matters more.
FittedPaint fit_paint(Polyline points);

}  // namespace relative_map::core
