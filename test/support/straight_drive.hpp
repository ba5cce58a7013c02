#pragma once

#include <cmath>
#include <stdexcept>

#include "support/scene.hpp"

namespace relative_map::core::test {

constexpr double kHalfWidth = 1.75;
constexpr double kStep = 1.0;  // [m] driven in a tick

inline const Lane& current(const RelativeMap& map) {
  for (const Lane& lane : map.lanes) {
    if (lane.id == map.current_lane_id) return lane;
  }
  throw std::out_of_range("no current lane: " + map.status.message);
}

inline double y_at(const RelativeMap& map, double x) {
  const PathPoints& path = current(map).path;
  for (std::size_t i = 1; i < path.size(); ++i) {
    const Point2 &a = path[i - 1].position, &b = path[i].position;
    if (b.x() >= x) return a.y() + (x - a.x()) / (b.x() - a.x()) * (b.y() - a.y());
  }
  throw std::out_of_range("the lane ends before");
}

/// A vehicle on a straight line along x, its true pose, and what sensors make of it.
class StraightDrive {
 public:
  explicit StraightDrive(const PipelineConfig& config = PipelineConfig())
      : scene({recording(straight(Pose2(), 3000.0, 1.0))}, config) {}

  /// The lane's paint from the true pose, exactly.
  LaneMarkers paint() const {
    const double slope = -std::tan(heading);
    LaneMarkers markers = lane_about({-y / std::cos(heading), slope, 0.0, 0.0}, half_width);
    return markers;
  }
  RelativeMap tick(const LaneMarkers& markers) {
    scene.see(markers);
    return tick();
  }
  RelativeMap tick() {
    x += kStep;
    return scene.at(Pose2(Point2(x, y) + bias, heading + heading_bias));
  }
  RelativeMap drive(int ticks) {
    RelativeMap map;
    for (int i = 0; i < ticks; ++i) map = tick(paint());
    return map;
  }
  /// [m] left positive, at `ahead` [m].
  double error(const RelativeMap& map, double ahead) const {
    return y_at(map, ahead) - (-y / std::cos(heading) - std::tan(heading) * ahead);
  }

  Scene scene;
  double x = 10.0, y = 0.2, heading = 0.0;
  double half_width = kHalfWidth;
  Point2 bias = Point2::Zero();
  double heading_bias = 0.0;
};

}  // namespace relative_map::core::test
