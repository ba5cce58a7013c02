#pragma once

#include <algorithm>
#include <vector>

#include "relative_map/geometry/pose2.hpp"

namespace relative_map::core {

/// A vertex of a path with the geometry of the curve there. The frame is the path's.
struct PathPoint {
  Point2 position = Point2::Zero();    ///< [m]
  Point2 direction = Point2::UnitX();  ///< unit tangent, (cos theta, sin theta)
  double theta = 0.0;                  ///< [rad] in (-pi, pi]
  double kappa = 0.0;                  ///< [1/m] positive to the left
  double dkappa = 0.0;                 ///< [1/m^2] by s
  double s = 0.0;                      ///< [m] chord length from the first point
};

using PathPoints = std::vector<PathPoint>;
using Polyline = std::vector<Point2>;

/// Whether a path is a lap: its last point is then followed by its first.
enum class Ends { kOpen, kClosed };

Polyline positions_of(const PathPoints& points);

/// Sets s to the chord length from the first point.
void compute_arc_length(PathPoints& points);

/// Sets direction, theta, kappa and dkappa from positions and s; needs two or more distinct points in a row.
/// theta and kappa are those of the circle through a point and its two neighbours (kappa by Menger's
/// formula, 4 area / product of sides), so they are exact on lines and circles, however unevenly sampled.
/// `lap_length` [m] is the chord length of a closed path, its closing segment included.
void compute_geometry(PathPoints& points, Ends ends = Ends::kOpen, double lap_length = 0.0);

/// The vertices at which a path turns by more than a right angle, rising. There the circle through three
/// points is none that it could follow.
std::vector<std::size_t> find_kinks(const PathPoints& points, Ends ends = Ends::kOpen);

/// The point at arc length s [m], linear between vertices, held at the ends. `hint` is a vertex to start
/// the search from, and comes back as the vertex at or before s: walking along a path costs O(1) a step.
PathPoint interpolate(const PathPoints& points, double s, std::size_t& hint);

/// The same on the cubics through the vertices with their directions: for coarse samples of a smooth curve.
PathPoint interpolate_smoothly(const PathPoints& points, double s, std::size_t& hint);

/// Where a point projects on a polyline.
struct Foot {
  std::size_t segment = 0;  ///< between vertices `segment` and `segment + 1`
  double fraction = 0.0;    ///< [0, 1] along the segment
  Point2 point = Point2::Zero();
  double squared_distance = 0.0;  ///< [m^2]
};

/// The nearest point of the segment a-b to `point`; `segment` of the result is 0.
inline Foot project_on_segment(const Point2& a, const Point2& b, const Point2& point) {
  const Point2 segment = b - a;
  const double squared_length = segment.squaredNorm();
  Foot foot;
  if (squared_length > 0.0) {
    foot.fraction = std::clamp((point - a).dot(segment) / squared_length, 0.0, 1.0);
  }
  foot.point = a + foot.fraction * segment;
  foot.squared_distance = (point - foot.point).squaredNorm();
  return foot;
}

/// Walks a polyline beside a moving point: each call starts at the segment where the last one ended and goes
/// on to the next foot, so that points in the polyline's order cost O(1) each.
class PolylineWalker {
 public:
  /// `polyline` must have two or more points and outlive the walker, which starts at `segment`.
  explicit PolylineWalker(const Polyline& polyline, std::size_t segment = 0)
      : polyline_(polyline), segment_(segment) {}
  /// `steps` >= 1: about how many vertices farther on than last time; a good guess saves the walk.
  Foot next(const Point2& point, std::size_t steps = 1);
  /// Whether a foot is held at an end of the polyline: the point lies beside nothing.
  bool beyond_end(const Foot& foot) const {
    return (foot.segment == 0 && foot.fraction <= 0.0) ||
           (foot.segment + 2 == polyline_.size() && foot.fraction >= 1.0);
  }

 private:
  bool beside_next_vertex(const Point2& point, Foot& foot);
  Foot search(const Point2& point);
  bool past_start(std::size_t segment, const Point2& point) const;
  bool past_end(std::size_t segment, const Point2& point) const;

  const Polyline& polyline_;
  std::size_t segment_;
};

// Where the polyline was made point by point beside what walks along it, its next vertex is always the near
// one.
inline bool PolylineWalker::beside_next_vertex(const Point2& point, Foot& foot) {
  const std::size_t i = segment_ + 1;
  if (i + 1 >= polyline_.size()) return false;
  const Point2& vertex = polyline_[i];
  const Point2 before = vertex - polyline_[i - 1], after = polyline_[i + 1] - vertex, offset = point - vertex;
  const double ahead = offset.dot(after), behind = -offset.dot(before);
  const double squared_after = after.squaredNorm(), squared_before = before.squaredNorm();
  // Nearer to another vertex, a segment past that one may be the nearest: look around.
  if (ahead > 0.5 * squared_after || behind > 0.5 * squared_before) return false;
  double along = 0.0;  // squared, by Pythagoras
  if (ahead > 0.0 && (behind <= 0.0 || ahead * ahead * squared_before > behind * behind * squared_after)) {
    foot.segment = i;
    foot.fraction = ahead / squared_after;
    foot.point = vertex + foot.fraction * after;
    along = ahead * foot.fraction;
  } else {
    const double back = behind > 0.0 ? behind / squared_before : 0.0;
    foot.segment = i - 1;
    foot.fraction = 1.0 - back;
    foot.point = vertex - back * before;
    along = back * std::max(0.0, behind);
  }
  foot.squared_distance = std::max(0.0, offset.squaredNorm() - along);  // on the polyline rounding may win
  segment_ = i;
  return true;
}

inline Foot PolylineWalker::next(const Point2& point, std::size_t steps) {
  segment_ = std::min(segment_ + steps, polyline_.size() - 1) - 1;
  Foot foot;
  return beside_next_vertex(point, foot) ? foot : search(point);
}

double chord_length(const Polyline& points);

/// [m] from the points of `line` to the other one, where that runs beside them: the longest such distance,
/// and where it is.
struct Gap {
  double width = 0.0;
  Point2 place = Point2::Zero();
};
Gap widest_gap(const Polyline& line, const Polyline& other);

}  // namespace relative_map::core
