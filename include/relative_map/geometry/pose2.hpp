#pragma once

#include <Eigen/Core>
#include <cmath>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

using Point2 = Eigen::Vector2d;

/// The unit vector 90 degrees to the left.
inline Point2 left_of(const Point2& direction) {
  return {-direction.y(), direction.x()};
}

/// z component of the cross product: positive where b points to the left of a.
inline double cross(const Point2& a, const Point2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// A frame's place in its parent frame: [m], [rad], counter-clockwise.
class Pose2 {
 public:
  Pose2() = default;
  Pose2(const Point2& position, double heading)
      : position_(position), heading_(heading), forward_(std::cos(heading), std::sin(heading)) {}

  const Point2& position() const { return position_; }
  double heading() const { return heading_; }
  /// Unit vector of the heading, in the parent frame.
  const Point2& forward() const { return forward_; }

  /// Subtracts before it rotates, so that map-sized (UTM) coordinates keep their last digits.
  Point2 to_local(const Point2& point) const { return rotate_to_local(point - position_); }
  Point2 to_parent(const Point2& point) const { return position_ + rotate_to_parent(point); }
  Point2 rotate_to_local(const Point2& vector) const {
    return {forward_.dot(vector), cross(forward_, vector)};
  }
  Point2 rotate_to_parent(const Point2& vector) const {
    return vector.x() * forward_ + vector.y() * left_of(forward_);
  }
  /// `other`, given in the same parent, as seen from this frame.
  Pose2 to_local(const Pose2& other) const {
    return {to_local(other.position_), angle_difference(other.heading_, heading_)};
  }
  /// `other`, given in this frame, as seen from the parent.
  Pose2 to_parent(const Pose2& other) const {
    return {to_parent(other.position_), normalize_angle(heading_ + other.heading_)};
  }

 private:
  Point2 position_ = Point2::Zero();
  double heading_ = 0.0;
  Point2 forward_ = Point2::UnitX();
};

}  // namespace relative_map::core
