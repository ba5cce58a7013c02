#pragma once

#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

enum class Side { kLeft = 1, kRight = -1 };

/// The point of a border that lies `half_width` [m] beside a vertex, or less inside of a curve that is
/// tighter: there the border would fold.
Point2 border_point(const PathPoints& points, std::size_t i, double half_width, Side side);

/// The border of a lane at its own half width [m], but nowhere nearer to the lane beside it, `other`, than to
/// its own centerline: two such borders never cross. Null: there is none beside.
Polyline own_border(const LanePath& lane, const LanePath* other, double half_width, Side side);

}  // namespace relative_map::core
