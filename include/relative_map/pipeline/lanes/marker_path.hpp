#pragma once

#include <optional>

#include "relative_map/geometry/cubic.hpp"
#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

/// The centerline between lane markers, and what was seen of them.
struct MarkerPath {
  LanePath path;
  double trusted_from = 0.0;                            ///< [m] s of the path from which on paint was seen
  double trusted_to = 0.0;                              ///< [m] s of the path up to which paint was seen
  std::optional<BoundaryType> left_paint, right_paint;  ///< none: not seen
};

/// The curve that such a path follows, and how far it may be believed.
struct Guide {
  Cubic cubic;
  double offset = 0.0;          ///< [m] of the path from the cubic, left positive
  double from = 0.0, to = 0.0;  ///< [m] x
  double left_half_width = 0.0, right_half_width = 0.0;
};

/// The path along `guide`, which is given in a frame that lies in the body as `base_from_frame` says. It is
/// sampled at x = -2, -1, 0 ... in that frame (from farther back, where that does not reach back to the
/// vehicle) up to a length proportional to `speed` [m/s]; past the guide the curvature fades to zero.
MarkerPath follow(const Guide& guide, const Pose2& base_from_frame, double speed,
                  const NavigationLaneParam& param);

}  // namespace relative_map::core
