#include "relative_map/pipeline/lines/line_walker.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kPastEnd = 0.5;  // [m] past an end that a point is still beside the line

}  // namespace

LineWalker::LineWalker(const NavigationLine& line, std::size_t vertex)
    : line_(line), segment_(line.closed() ? vertex : std::min(vertex, line.points.size() - 2)) {}

BesideLine LineWalker::beside(const Point2& point) {
  Foot foot = project(point);
  int last_step = 0;
  while (true) {
    const int step = step_from(foot);
    if (step == 0 || step == -last_step) break;  // at a corner both segments send the point on
    take(step);
    last_step = step;
    foot = project(point);
  }
  const PathPoint &a = first(), &b = second();
  const Point2 direction = (a.direction + foot.fraction * (b.direction - a.direction)).normalized();
  const Point2 offset = point - foot.point;
  const bool at_vertex = foot.fraction >= 1.0 || foot.fraction <= 0.0;
  const bool beyond = at_vertex && std::abs(direction.dot(offset)) > kPastEnd;
  return {a.s + foot.fraction * length(), cross(direction, offset), left_of(direction), !beyond};
}

int LineWalker::step_from(const Foot& foot) const {
  const bool can_go_on = line_.closed() || segment_ + 2 < line_.points.size();
  const bool can_go_back = line_.closed() || segment_ > 0;
  if (foot.fraction >= 1.0 && can_go_on) return 1;
  return foot.fraction <= 0.0 && can_go_back ? -1 : 0;
}

void LineWalker::take(int step) {
  const std::size_t segments = line_.points.size();  // of a lap; an open line never wraps
  segment_ = step > 0 ? (segment_ + 1) % segments : (segment_ + segments - 1) % segments;
}

}  // namespace relative_map::core
