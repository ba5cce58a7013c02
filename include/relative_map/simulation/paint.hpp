#pragma once

#include "relative_map/geometry/cubic.hpp"
#include "relative_map/geometry/path_point.hpp"
#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/drive_path.hpp"

namespace relative_map::core {

/// A line of paint that runs beside a path, and may leave its place for a while, as at a merge.
struct PaintLine {
  double l = 0.0;  ///< [m] to the left of the path
  BoundaryType type = BoundaryType::kDottedWhite;
  double shift = 0.0;               ///< [m] to the left, of the stretch that has left its place
  double from_s = 0.0, to_s = 0.0;  ///< [m] where it is all that far away ...
  double ramp = 40.0;               ///< ... and the length [m] over which it goes there and comes back
  bool painted = true;              ///< false: the lane's border is there, but nothing to be seen
  double wave = 0.0;  ///< [m] by which it sways about its place, as lanes change their width ...
  double wave_length = 100.0, wave_phase = 0.0;  ///< ... over so many [m], from a phase [rad] on

  double l_at(double s) const;
  /// [m] to the left of its place.
  double wave_at(double s) const;
};

/// How far a camera sees.
struct Sight {
  double range = 50.0;     ///< [m] in x
  double max_turn = 0.78;  ///< [rad] by which the road may turn from the camera's axis
  double nearest = 0.0;    ///< [m] in x; 0: from beside the camera on
  double max_kappa = 1e9;  ///< [1/m] where the road is bent more sharply than that, it has no paint
};

/// What a camera in the body frame sees of the paint beside a path: a point each metre, from the path's s [m]
/// to the first one past the sight's range, or to where the path or its paint ends or turns out of sight.
/// `base` is the body's pose in the path's frame, `vertex` the path's vertex at or near s.
Polyline visible_paint(const DrivePath& path, double s, std::size_t vertex, const PaintLine& line,
                       const Pose2& base, const Sight& sight);

/// The cubic with the least squared distances in y from four or more points of rising x.
Cubic fit_cubic(const Polyline& points);

struct FittedPaint {
  Cubic cubic;
  double range = 0.0;  ///< [m] x up to which the cubic follows the paint; 0: too little is seen to fit one
};

/// Fits a cubic to as much of the paint as it can follow to `max_residual` [m], from the near end on: a bend
/// in which a straight becomes a sharp curve is no cubic, and the near part matters more.
FittedPaint fit_paint(Polyline points, double max_residual = 0.05);

}  // namespace relative_map::core
