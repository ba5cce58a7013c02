#include "relative_map/pipeline/navigation_line_window.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr long kVerticesBehind = 3;
constexpr double kThinnedReach = 2.0;  // [m] behind the nearest vertex of a thinned line

/// Steps along a line's vertices; on a lap it goes on past the stitch, and s with it.
class VertexCursor {
 public:
  VertexCursor(const NavigationLine& line, std::size_t vertex) : line_(line), vertex_(vertex) {}

  bool has_next() const { return line_.closed() || vertex_ + 1 < line_.points.size(); }
  bool has_previous() const { return line_.closed() || vertex_ > 0; }
  void next() {
    if (++vertex_ < line_.points.size()) return;
    vertex_ = 0;
    lap_start_ += line_.length;
  }
  void previous() {
    if (vertex_ == 0) {
      vertex_ = line_.points.size();
      lap_start_ -= line_.length;
    }
    --vertex_;
  }
  const PathPoint& point() const { return line_.points[vertex_]; }
  double s() const { return lap_start_ + point().s; }

 private:
  const NavigationLine& line_;
  std::size_t vertex_;
  double lap_start_ = 0.0;
};

VertexCursor window_start(const NavigationLine& line, std::size_t nearest_vertex) {
  VertexCursor cursor(line, nearest_vertex);
  const double nearest_s = cursor.s();
  const double reach = line.thinned ? kThinnedReach : 0.0;
  for (long behind = 0; cursor.has_previous(); ++behind) {
    if (behind >= kVerticesBehind && nearest_s - cursor.s() >= reach) break;
    cursor.previous();
  }
  return cursor;
}

}  // namespace

LanePath cut_window(const NavigationLine& line, const LineProjection& projection, const Pose2& map_from_base,
                    double max_length) {
  const double heading = map_from_base.heading();
  // The vehicle in the line's own coordinates, so that no large number enters the rotation.
  const Pose2 line_from_base(map_from_base.position() - line.origin, heading);
  VertexCursor cursor = window_start(line, projection.nearest_vertex);
  const double start = cursor.s();

  LanePath path;
  path.id = line.id;
  path.name = line.name;
  path.priority = line.priority;
  path.l = projection.l;
  path.remaining = projection.remaining;
  path.points.reserve(static_cast<std::size_t>(static_cast<double>(line.points.size()) * max_length /
                                               std::max(line.length, max_length)) +
                      16);
  while (true) {
    const PathPoint& vertex = cursor.point();
    PathPoint point = vertex;
    point.position = line_from_base.to_local(vertex.position);
    point.direction = line_from_base.rotate_to_local(vertex.direction);
    point.theta = angle_difference(vertex.theta, heading);
    point.s = cursor.s() - start;
    path.points.push_back(point);
    if (point.s > max_length || !cursor.has_next()) break;
    cursor.next();
  }
  // The start may lie before the stitch that the vehicle has just passed, or the other way round.
  const double behind =
      line.closed() ? std::remainder(projection.s - start, line.length) : projection.s - start;
  path.s_at_vehicle = behind;
  return path;
}

}  // namespace relative_map::core
