#pragma once

#include <memory>
#include <vector>

#include "relative_map/geometry/path_point.hpp"

namespace relative_map::core {

/// Finds the places where a path passes by a point, in logarithmic time.
/// Runs of segments share one box of the R-tree: it is built faster, and a query still looks at few.
class SegmentIndex {
 public:
  SegmentIndex() = default;
  /// Two or more points; a closed path has one more segment, from its last point to its first.
  SegmentIndex(const PathPoints& points, Ends ends);

  /// The local minima of the distance from `point` to the path, up to `max_distance` [m], by rising
  /// segment. `points` must be those that the index was built from.
  std::vector<Foot> passes(const PathPoints& points, const Point2& point, double max_distance) const;

  /// The nearest point of the path, wherever it is.
  Foot nearest(const PathPoints& points, const Point2& point) const;

 private:
  struct Tree;  ///< hidden: Boost.Geometry is slow to compile

  Foot project(const PathPoints& points, std::size_t segment, const Point2& point) const;

  std::shared_ptr<const Tree> tree_;
  std::size_t segments_ = 0;
};

}  // namespace relative_map::core
