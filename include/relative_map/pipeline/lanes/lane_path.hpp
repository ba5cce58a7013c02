#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/geometry/path_point.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// Half widths that paint has shown; none: not on that side.
struct SeenHalfWidths {
  std::optional<double> left, right;  ///< [m]
  double to = 0.0;                    ///< [m] s up to which
};

/// One lane on its way through the stages: its centerline in the body frame and what is known of it.
struct LanePath {
  std::string id;
  std::string name;
  std::uint32_t priority = 0;
  PathPoints points;              ///< s from 0
  double s_at_vehicle = 0.0;      ///< [m] where the vehicle is beside it; outside the path: beyond its ends
  double l = 0.0;                 ///< [m] of the vehicle, left of the path positive
  double remaining = 0.0;         ///< [m] to the end of the line
  double left_half_width = 0.0;   ///< [m] where no neighbour bounds it
  double right_half_width = 0.0;  ///< [m] where no neighbour bounds it
  std::optional<SeenHalfWidths> seen;
};

/// Sets s_at_vehicle and l from the points: where the origin of the body frame is beside the path, or beside
/// the tangent at an end that it lies beyond. The search starts at the first point.
void locate_vehicle(LanePath& lane);

/// By the vehicle's place beside them; a lane that begins ahead by where its start lies beside the others.
/// `current` goes with its lane.
void sort_left_to_right(std::vector<LanePath>& lanes, std::size_t& current);

}  // namespace relative_map::core
