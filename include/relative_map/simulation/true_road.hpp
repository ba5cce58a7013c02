#pragma once

#include <cstddef>
#include <limits>
#include <vector>

#include "relative_map/simulation/drive_path.hpp"
#include "relative_map/simulation/paint.hpp"

namespace relative_map::core {

/// A lane as it really is, between two of the road's lines of paint.
struct TrueLane {
  double l = 0.0;           ///< [m] of its center, to the left of the road's reference curve, but for waves
  double half_width = 0.0;  ///< [m] where the paint is in its place, likewise
  std::size_t left_paint = 0, right_paint = 0;
};

/// A place on a road, in the frame of its path.
struct RoadPlace {
  double s = 0.0;  ///< [m] along the reference curve
  Point2 position = Point2::Zero();
  Point2 direction = Point2::UnitX();
};

/// What maps are measured against: a reference curve, and lanes and paint that run beside it.
struct TrueRoad {
  DrivePath path;
  std::vector<TrueLane> lanes;                             ///< left to right
  std::vector<PaintLine> paint;                            ///< left to right
  double end_s = std::numeric_limits<double>::infinity();  ///< [m] where the recorded lines end

  RoadPlace at(double s, double l) const;
  /// [m] of a lane's center, to the left of the reference curve at s [m], and its half width [m] there: in
  /// the middle between its lines of paint, where these are in their places.
  double center_at(const TrueLane& lane, double s) const;
  double half_width_at(const TrueLane& lane, double s) const;
  /// The places on the center of a lane at rising distances [m] along it from where it passes s; those past
  /// the end of the road, or of the lines, are missing.
  std::vector<RoadPlace> ahead(const TrueLane& lane, double s, const std::vector<double>& distances) const;
  /// The lanes that a vehicle l [m] beside the reference curve may be said to be in: one, or near the line
  /// between two of them, both. By index.
  std::vector<std::size_t> lanes_at(double l) const;

 private:
  double wave_at(std::size_t line, double s) const {
    return line < paint.size() ? paint[line].wave_at(path.hold(s)) : 0.0;
  }
};

}  // namespace relative_map::core
