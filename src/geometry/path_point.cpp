#include "relative_map/geometry/path_point.hpp"

#include <algorithm>

namespace relative_map::core {

namespace {

constexpr double kRightAngle = 0.005;   // cosine that still counts as 0
constexpr std::size_t kLookAround = 4;  // segments past the nearest one that may be nearer yet

/// Signed curvature of the circle through three points; 0 where two of them coincide.
double menger_curvature(const Point2& a, const Point2& b, const Point2& c) {
  const double sides = (b - a).norm() * (c - b).norm() * (c - a).norm();
  return sides > 0.0 ? 2.0 * cross(b - a, c - b) / sides : 0.0;
}

/// Direction, theta and kappa at b of the circle through a, b and c.
void set_from_circle(const Point2& a, const Point2& b, const Point2& c, PathPoint& point) {
  const Point2 before = b - a, after = c - b;
  // On a circle the tangent halves the angle between chords of equal length; for others the turn is
  // shared out by the chords' lengths, which is what weighting each chord by the other's square does.
  const Point2 tangent = before * after.squaredNorm() + after * before.squaredNorm();
  const Point2& fallback = before;  // a about-turn on the spot has no tangent
  point.direction = (tangent.squaredNorm() > 0.0 ? tangent : fallback).normalized();
  point.kappa = menger_curvature(a, b, c);
}

/// The tangent at the end of a chord of a circle, given the tangent at the other end: mirrored at the chord.
Point2 mirrored(const Point2& direction, const Point2& chord) {
  const Point2 axis = chord.normalized();
  return 2.0 * axis.dot(direction) * axis - direction;
}

void set_open_ends(PathPoints& points) {
  const std::size_t last = points.size() - 1;
  const Point2 first_chord = points[1].position - points[0].position;
  const Point2 last_chord = points[last].position - points[last - 1].position;
  if (last == 1) {
    points[0].direction = points[1].direction = first_chord.normalized();
    points[0].kappa = points[1].kappa = 0.0;
    return;
  }
  points[0].direction = mirrored(points[1].direction, first_chord);
  points[0].kappa = points[1].kappa;
  points[last].direction = mirrored(points[last - 1].direction, last_chord);
  points[last].kappa = points[last - 1].kappa;
}

}  // namespace

Polyline positions_of(const PathPoints& points) {
  Polyline positions;
  positions.reserve(points.size());
  for (const PathPoint& point : points) positions.push_back(point.position);
  return positions;
}

void compute_arc_length(PathPoints& points) {
  double s = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (i > 0) s += (points[i].position - points[i - 1].position).norm();
    points[i].s = s;
  }
}

void compute_geometry(PathPoints& points, Ends ends, double lap_length) {
  const std::size_t n = points.size();
  const bool closed = ends == Ends::kClosed;
  for (std::size_t i = closed ? 0 : 1; i + (closed ? 0 : 1) < n; ++i) {
    const Point2& before = points[i == 0 ? n - 1 : i - 1].position;
    const Point2& after = points[i + 1 == n ? 0 : i + 1].position;
    set_from_circle(before, points[i].position, after, points[i]);
  }
  if (!closed) set_open_ends(points);
  for (std::size_t i = 0; i < n; ++i) {
    PathPoint& point = points[i];
    point.theta = std::atan2(point.direction.y(), point.direction.x());
    const std::size_t before = i == 0 ? (closed ? n - 1 : 0) : i - 1;
    const std::size_t after = i + 1 == n ? (closed ? 0 : i) : i + 1;
    double ds = points[after].s - points[before].s;
    if (closed && (i == 0 || i + 1 == n)) ds += lap_length;
    point.dkappa = (points[after].kappa - points[before].kappa) / ds;
  }
}

std::vector<std::size_t> find_kinks(const PathPoints& points, Ends ends) {
  std::vector<std::size_t> kinks;
  const std::size_t n = points.size(), open = ends == Ends::kOpen ? 1 : 0;
  for (std::size_t i = open; i + open < n; ++i) {
    const Point2 before = points[i].position - points[i == 0 ? n - 1 : i - 1].position;
    const Point2 after = points[i + 1 == n ? 0 : i + 1].position - points[i].position;
    const double along = before.dot(after);
    if (along < 0.0 && std::abs(along) > kRightAngle * before.norm() * after.norm()) kinks.push_back(i);
  }
  return kinks;
}

PathPoint interpolate(const PathPoints& points, double s, std::size_t& hint) {
  if (s <= points.front().s) {
    hint = 0;
    return points.front();
  }
  if (s >= points.back().s) {
    hint = points.size() - 1;
    return points.back();
  }
  while (hint > 0 && points[hint].s > s) --hint;
  while (points[hint + 1].s <= s) ++hint;
  const PathPoint& a = points[hint];
  const PathPoint& b = points[hint + 1];
  const double weight = (s - a.s) / (b.s - a.s);
  PathPoint point;
  point.position = a.position + weight * (b.position - a.position);
  point.direction = (a.direction + weight * (b.direction - a.direction)).normalized();
  point.theta = interpolate_angle(a.theta, b.theta, weight);
  point.kappa = a.kappa + weight * (b.kappa - a.kappa);
  point.dkappa = a.dkappa + weight * (b.dkappa - a.dkappa);
  point.s = s;
  return point;
}

PathPoint interpolate_smoothly(const PathPoints& points, double s, std::size_t& hint) {
  PathPoint point = interpolate(points, s, hint);
  if (hint + 1 == points.size()) return point;
  const PathPoint& a = points[hint];
  const PathPoint& b = points[hint + 1];
  const double length = b.s - a.s, t = (point.s - a.s) / length, u = 1.0 - t;
  // Hermite's cubic, as what it adds to the chord.
  const Point2 chord = (b.position - a.position) / length;
  point.position += length * t * u * (u * (a.direction - chord) - t * (b.direction - chord));
  return point;
}

bool PolylineWalker::past_start(std::size_t segment, const Point2& point) const {
  return (point - polyline_[segment]).dot(polyline_[segment + 1] - polyline_[segment]) > 0.0;
}

bool PolylineWalker::past_end(std::size_t segment, const Point2& point) const {
  return (point - polyline_[segment + 1]).dot(polyline_[segment + 1] - polyline_[segment]) > 0.0;
}

Foot PolylineWalker::search(const Point2& point) {
  const std::size_t last = polyline_.size() - 2, start = segment_;
  while (segment_ < last && past_end(segment_, point)) ++segment_;
  if (segment_ == start) {
    while (segment_ > 0 && !past_start(segment_, point)) --segment_;
  }
  const auto foot_on = [&](std::size_t segment) {
    Foot foot = project_on_segment(polyline_[segment], polyline_[segment + 1], point);
    foot.segment = segment;
    return foot;
  };
  Foot best = foot_on(segment_);
  // On the inside of a curve the point lies beside several segments at once, and a kink may hide a nearer
  // one.
  const auto take_nearer = [&](const Foot& foot) {
    if (foot.squared_distance < best.squared_distance) best = foot;
  };
  for (std::size_t i = segment_ + 1; i <= std::min(last, best.segment + kLookAround); ++i)
    take_nearer(foot_on(i));
  for (std::size_t i = segment_; i-- > 0 && i + kLookAround >= best.segment;) take_nearer(foot_on(i));
  segment_ = best.segment;
  return best;
}

Gap widest_gap(const Polyline& line, const Polyline& other) {
  PolylineWalker walker(other);
  Gap widest;
  double squared = 0.0;
  for (const Point2& point : line) {
    const Foot foot = walker.next(point);
    if (foot.squared_distance <= squared || walker.beyond_end(foot)) continue;
    squared = foot.squared_distance;
    widest = {std::sqrt(squared), point};
  }
  return widest;
}

double chord_length(const Polyline& points) {
  double length = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) length += (points[i] - points[i - 1]).norm();
  return length;
}

}  // namespace relative_map::core
