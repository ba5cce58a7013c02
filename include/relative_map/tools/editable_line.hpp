#pragma once

#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A navigation line to work on. Positions are relative to `origin`, so that map-sized coordinates cost no
/// digits; no two that follow each other are nearer than 1 mm. A closed line's last point is not its first
/// one again; `repeats_start` says that the file had it so, and shall have it again.
struct EditableLine {
  std::string name;
  Point2 origin = Point2::Zero();  ///< [m] map frame
  Polyline points;
  std::vector<double> z;  ///< [m] one a point; NaN: not given
  Ends ends = Ends::kOpen;
  bool repeats_start = false;

  bool closed() const { return ends == Ends::kClosed; }
  /// [m] the chord from the last point to the first of a closed line; 0 of an open one.
  double closing_length() const;
};

/// Throws std::runtime_error, one sentence, if a coordinate is not finite or there are fewer than two
/// distinct points. Closed: 30 m or longer, with ends not farther apart than its points are there, and in one
/// direction.
EditableLine make_editable(const RecordedLine& recorded);

/// With s, and theta, kappa and dkappa as compute_geometry() has them.
RecordedLine make_recorded(const EditableLine& line);

/// The same geometry, relative to the line's origin; a closed line's start is not repeated.
PathPoints path_of(const EditableLine& line);

/// The length [m], a closed line's last chord included.
double length_of(const EditableLine& line);

}  // namespace relative_map::core
