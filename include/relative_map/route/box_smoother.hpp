#pragma once

#include <vector>

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

/// A point that a smooth line passes by, and how far beside it.
struct Anchor {
  Point2 point = Point2::Zero();
  Point2 left = Point2::UnitY();  ///< unit vector, along which the line may move
  double lower = 0.0;             ///< [m] least and
  double upper = 0.0;             ///< [m] greatest offset to the left
  double wanted = 0.0;            ///< [m] offset that it is drawn to
};

/// The offsets [m] of the line of least curvature change within the bounds: it minimises the sum of the
/// squared third differences of the points, and of `follow` times the squared distances from the wanted
/// offsets. A convex program, solved by a primal-dual interior-point method (Mehrotra's step lengths) on a
/// banded matrix in O(anchors) a round. The anchors should be about as far apart as each other. Where lower
/// and upper are less than a tenth of a millimetre apart, the offset is their mean. Empty if the numbers
/// fail.
std::vector<double> smooth_within(const std::vector<Anchor>& anchors, double follow);

}  // namespace relative_map::core
