#include "relative_map/pipeline/paint/frozen_paint.hpp"

#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kShapeReach = 30.0;  // [m] ahead, where a change of the line's direction is looked for
// [rad] of the line's direction at the vehicle and there: paint can't have stayed the same beside it.
const Eigen::Vector2d kShapeChange(0.03, 0.05);

}  // namespace

bool FrozenPaint::look(bool unchanged, const Pose2& pose, const NavigationLine& line, std::size_t vertex) {
  // By headings, since localization's position drifts and jumps.
  const Point2 position = pose.position() - line.origin;
  LineWalker walker(line, vertex);
  Eigen::Vector2d shape;
  for (int i = 0; i < 2; ++i) {
    const Point2 normal = walker.beside(position + i * kShapeReach * pose.forward()).normal;
    shape[i] = std::atan2(-pose.forward().dot(normal), -cross(pose.forward(), normal));
  }
  if (!unchanged || line.id != line_id_) {
    frozen_ = false;
    line_id_ = line.id;
    line_shape_ = shape;
  }
  if (((shape - line_shape_).cwiseAbs().array() > kShapeChange.array()).any()) frozen_ = true;
  return frozen_;
}

}  // namespace relative_map::core
