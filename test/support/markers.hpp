#pragma once

#include <utility>

#include "relative_map/model/inputs.hpp"

// Lane markers as a camera would report them.
namespace relative_map::core::test {

inline LaneMarker marker(const Cubic& cubic, double view_range = 50.0, double quality = 0.9) {
  LaneMarker marker;
  marker.type = BoundaryType::kDottedWhite;
  marker.quality = quality;
  marker.cubic = cubic;
  marker.view_range = view_range;
  return marker;
}

/// Both sides of a lane about `center`, `half_width` [m] from it along y.
inline LaneMarkers lane_about(const Cubic& center, double half_width = 1.75, double view_range = 50.0) {
  LaneMarkers markers;
  markers.stamp = at_seconds(1.0);
  Cubic left = center, right = center;
  left.c0 += half_width;
  right.c0 -= half_width;
  markers.left = marker(left, view_range);
  markers.right = marker(right, view_range);
  return markers;
}

inline Cubic mirrored(const Cubic& cubic) {
  return {-cubic.c0, -cubic.c1, -cubic.c2, -cubic.c3};
}

/// As the driver sees them in a mirror: left and right change places.
inline LaneMarkers mirrored(LaneMarkers markers) {
  std::swap(markers.left, markers.right);
  markers.left.cubic = mirrored(markers.left.cubic);
  markers.right.cubic = mirrored(markers.right.cubic);
  return markers;
}

}  // namespace relative_map::core::test
