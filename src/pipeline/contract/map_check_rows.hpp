#pragma once

#include <optional>
#include <sstream>
#include <string>

#include "relative_map/pipeline/contract/map_check.hpp"

// The rows of the output contract that look at geometry, and what all rows are written with.
namespace relative_map::core {

constexpr double kLengthTolerance = 1e-3;  // [m] a point

/// What breaks a row; none: the row holds.
using Fault = std::optional<std::string>;

template <class... Parts>
Fault fault(const Parts&... parts) {
  std::ostringstream text;
  text.precision(6);
  (text << ... << parts);
  return text.str();
}

/// The first fault that `check` finds in any lane, with the lane's id before it.
template <class Check>
Fault first_in_lanes(const RelativeMap& map, Check check) {
  for (const Lane& lane : map.lanes) {
    if (Fault found = check(lane)) return fault("lane '", lane.id, "': ", *found);
  }
  return std::nullopt;
}

/// These need finite numbers, and paths and boundaries of two or more points.
Fault check_arc_length(const RelativeMap& map, const MapContext& context);
Fault check_heading(const RelativeMap& map, const MapContext& context);
Fault check_curvature(const RelativeMap& map, const MapContext& context);
Fault check_curvature_rate(const RelativeMap& map, const MapContext& context);
/// Two rows that one walk along the borders tells.
struct BorderFaults {
  Fault samples, sides;
  std::size_t lane = 0;  ///< of the first fault
  double s = 0.0;        ///< [m] likewise, along that lane
};
BorderFaults check_borders(const RelativeMap& map, const MapContext& context);
Fault check_neighbors(const RelativeMap& map, const MapContext& context);

}  // namespace relative_map::core
