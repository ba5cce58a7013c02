#include "relative_map/pipeline/lanes/navigation_line_window.hpp"

#include <algorithm>
#include <cmath>

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
  bool at_kink() const { return line_.is_kink(vertex_); }
  double s() const { return lap_start_ + point().s; }

 private:
  const NavigationLine& line_;
  std::size_t vertex_;
  double lap_start_ = 0.0;
};

/// [m] along the line from one place to another; the short way round on a lap.
double way(const NavigationLine& line, double from, double to) {
  return line.closed() ? std::remainder(to - from, line.length) : to - from;
}

VertexCursor window_start(const NavigationLine& line, const LineProjection& projection) {
  VertexCursor cursor(line, projection.nearest_vertex);
  const double nearest_s = cursor.s();
  const double reach = line.thinned ? kThinnedReach : 0.0;
  const bool vehicle_is_past = way(line, nearest_s, projection.s) >= 0.0;
  for (long behind = 0; cursor.has_previous(); ++behind) {
    if (behind >= kVerticesBehind && nearest_s - cursor.s() >= reach) break;
    // The nearest vertex may be a kink that is yet ahead.
    if (cursor.at_kink() && (behind > 0 || vehicle_is_past)) break;
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
  VertexCursor cursor = window_start(line, projection);
  const double start = cursor.s();
  const bool from_kink = cursor.at_kink();
  bool to_kink = false;

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
    to_kink = cursor.at_kink() && path.points.size() > 1;
    if (to_kink || point.s > max_length || !cursor.has_next()) break;
    cursor.next();
  }
  // The start may lie before the stitch that the vehicle has just passed, or the other way round.
  path.s_at_vehicle = way(line, start, projection.s);
  if (from_kink || to_kink) compute_geometry(path.points);  // of one side of the kink alone
  if (to_kink) path.remaining = path.points.back().s - path.s_at_vehicle;
  return path;
}

std::vector<LanePath> cut_windows(const TrackedLines& lines, const VehicleState& vehicle,
                                  const PipelineConfig& config) {
  std::vector<LanePath> lanes;
  lanes.reserve(lines.lines.size());
  for (const TrackedLine& found : lines.lines) {
    lanes.push_back(cut_window(*found.line, found.projection, vehicle.map_from_base,
                               config.navigation_lane.max_len_from_navigation_line));
    lanes.back().left_half_width = config.map_param.default_left_width;
    lanes.back().right_half_width = config.map_param.default_right_width;
  }
  return lanes;
}

}  // namespace relative_map::core
