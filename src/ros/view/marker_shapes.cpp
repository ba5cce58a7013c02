#include "relative_map/ros/view/marker_shapes.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map {

namespace {

using geometry_msgs::Point;

constexpr double kNearStep = 1.0;   // [m] finer shapes can't be told apart on a screen
constexpr double kFarStep = 0.02;   // [m] a metre of distance
constexpr double kSearched = 25.0;  // [m] along a curve, in which the vehicle is beside it

double squared_distance(const Point& a, const Point& b) {
  return (b.x - a.x) * (b.x - a.x) + (b.y - a.y) * (b.y - a.y);
}

double distance(const Point& a, const Point& b) {
  return std::hypot(b.x - a.x, b.y - a.y);
}

Point between(const Point& a, const Point& b, double share) {
  Point point;
  point.x = a.x + share * (b.x - a.x);
  point.y = a.y + share * (b.y - a.y);
  point.z = a.z + share * (b.z - a.z);
  return point;
}

}  // namespace

std_msgs::ColorRGBA color(double r, double g, double b, double a) {
  std_msgs::ColorRGBA c;
  c.r = static_cast<float>(r);
  c.g = static_cast<float>(g);
  c.b = static_cast<float>(b);
  c.a = static_cast<float>(a);
  return c;
}

visualization_msgs::Marker make_marker(const MapMsg& map, const std::string& ns, int id, int type) {
  visualization_msgs::Marker marker;
  marker.header = map.header;
  marker.ns = ns;
  marker.id = id;
  marker.type = type;
  marker.action = visualization_msgs::Marker::ADD;
  marker.pose.orientation.w = 1.0;
  return marker;
}

Points thinned(const Curve& curve) {
  Points points;
  for (const CurveSegment& segment : curve.segment) {
    for (const Point& point : segment.line_segment.point) {
      const bool last = &point == &segment.line_segment.point.back();
      // Squares: most of the time for rviz goes into this.
      const double squared_step =
          std::max(kNearStep * kNearStep, kFarStep * kFarStep * (point.x * point.x + point.y * point.y));
      if (points.empty() || last || squared_distance(points.back(), point) >= squared_step) {
        points.push_back(point);
      }
    }
  }
  return points;
}

double s_beside_vehicle(const Points& points) {
  double s = 0.0, nearest = 0.0, least = points.empty() ? 0.0 : std::hypot(points[0].x, points[0].y);
  for (std::size_t i = 1; i < points.size() && s < kSearched; ++i) {
    const double length = distance(points[i - 1], points[i]);
    if (length > 0.0) {
      const double along = -(points[i - 1].x * (points[i].x - points[i - 1].x) +
                             points[i - 1].y * (points[i].y - points[i - 1].y)) /
                           length;
      const Point foot = between(points[i - 1], points[i], std::clamp(along / length, 0.0, 1.0));
      if (std::hypot(foot.x, foot.y) < least) {
        least = std::hypot(foot.x, foot.y);
        nearest = s + std::clamp(along, 0.0, length);
      }
    }
    s += length;
  }
  return nearest;
}

Points shifted(const Points& points, double left) {
  Points moved = points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Point &before = points[i > 0 ? i - 1 : i], &after = points[std::min(i + 1, points.size() - 1)];
    const double length = distance(before, after);
    if (!(length > 0.0)) continue;
    moved[i].x -= left * (after.y - before.y) / length;
    moved[i].y += left * (after.x - before.x) / length;
  }
  return moved;
}

void append_stroke(const Points& points, double from, double to, const Dashes& dashes, double z,
                   Points& pairs) {
  const auto append = [&](Point point) {
    point.z += z;
    pairs.push_back(point);
  };
  double s = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    const double length = distance(points[i - 1], points[i]);
    const double end = std::min(to, s + length);
    for (double a = std::max(from, s); a < end;) {
      double b = end;
      bool gap = false;
      if (dashes.length > 0.0) {
        const double count = std::floor((a + dashes.phase) / dashes.length + 1e-9);
        gap = std::fmod(count, 2.0) != 0.0;
        b = std::min(end, (count + 1.0) * dashes.length - dashes.phase);
        if (!(b > a)) break;  // numbers too large for a dash to matter
      }
      if (!gap) {
        append(between(points[i - 1], points[i], (a - s) / length));
        append(between(points[i - 1], points[i], (b - s) / length));
      }
      a = b;
    }
    s += length;
  }
}

}  // namespace relative_map
