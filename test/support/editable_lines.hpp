#pragma once

#include "relative_map/tools/line_edit.hpp"
#include "support/lines.hpp"

namespace relative_map::core::test {

inline EditableLine editable(const Polyline& points) {
  return make_editable(recording(points));
}
/// Counter-clockwise about the origin.
inline EditableLine lap(double radius, std::size_t count) {
  return editable(circle(radius, count));
}

}  // namespace relative_map::core::test
