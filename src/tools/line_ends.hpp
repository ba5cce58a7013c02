#pragma once

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

constexpr double kMaxTurn = 0.8;  // [rad] between ends that are to meet

/// [m] that a direction has to be taken from: the more, the more the points scatter.
double direction_length(const Polyline& points);

/// Unit direction at the first, or the last, point: as the metres from there lead, and bend. Two or more
/// distinct points.
Point2 direction_at_start(const Polyline& points);
Point2 direction_at_end(const Polyline& points);

/// [rad] in [0, pi].
double angle_between(const Point2& a, const Point2& b);

}  // namespace relative_map::core
