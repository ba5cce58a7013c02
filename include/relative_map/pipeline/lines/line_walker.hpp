#pragma once

#include "relative_map/pipeline/lines/navigation_lines.hpp"

namespace relative_map::core {

/// Where a point lies beside a line.
struct BesideLine {
  double s = 0.0;        ///< [m] of the foot
  double lateral = 0.0;  ///< [m] left positive
  Point2 normal;         ///< to the left
  bool exists = false;   ///< false: beyond an end
};

/// Walks a navigation line, across the stitch of a closed one, beside a moving point: each call starts at the
/// segment where the last one ended.
class LineWalker {
 public:
  /// `line` must outlive the walker, which starts at `vertex`.
  LineWalker(const NavigationLine& line, std::size_t vertex);
  /// `point` is relative to the line's origin.
  BesideLine beside(const Point2& point);

 private:
  const PathPoint& first() const { return line_.points[segment_]; }
  const PathPoint& second() const {
    return line_.points[segment_ + 1 == line_.points.size() ? 0 : segment_ + 1];
  }
  double length() const {
    return (segment_ + 1 == line_.points.size() ? line_.length : second().s) - first().s;
  }
  Foot project(const Point2& point) const {
    return project_on_segment(first().position, second().position, point);
  }
  int step_from(const Foot& foot) const;
  void take(int step);

  const NavigationLine& line_;
  std::size_t segment_;
};

}  // namespace relative_map::core
