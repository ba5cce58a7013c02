#include "relative_map/ros/map_markers.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/ros/conversions.hpp"

namespace relative_map {

namespace {

using visualization_msgs::Marker;
using Points = std::vector<geometry_msgs::Point>;

constexpr double kDrawStep = 1.0;     // [m] finer shapes can't be told apart on a screen
constexpr double kDashLength = 3.0;   // [m] of a dotted line, and of the gap after it
constexpr double kMarkerLift = 0.06;  // [m] what was seen is drawn above what was made of it
constexpr double kBoundaryLift = 0.03;

std_msgs::ColorRGBA color(double r, double g, double b, double a) {
  std_msgs::ColorRGBA c;
  c.r = static_cast<float>(r);
  c.g = static_cast<float>(g);
  c.b = static_cast<float>(b);
  c.a = static_cast<float>(a);
  return c;
}

// Okabe and Ito's palette, which colour-blind people can tell apart.
std_msgs::ColorRGBA kBlue() {
  return color(0.05, 0.60, 1.0, 0.85);
}
std_msgs::ColorRGBA kTeal() {
  return color(0.0, 0.85, 0.62, 0.60);
}
std_msgs::ColorRGBA kGrey() {
  return color(0.80, 0.80, 0.88, 0.45);
}
std_msgs::ColorRGBA kOrange() {
  return color(0.90, 0.60, 0.0, 1.0);
}
std_msgs::ColorRGBA kVermillion() {
  return color(0.84, 0.37, 0.0, 1.0);
}
std_msgs::ColorRGBA kSky() {
  return color(0.34, 0.71, 0.91, 1.0);
}

Marker make_marker(const MapMsg& map, const std::string& ns, int id, int type) {
  Marker marker;
  marker.header = map.header;
  marker.ns = ns;
  marker.id = id;
  marker.type = type;
  marker.action = Marker::ADD;
  marker.pose.orientation.w = 1.0;
  return marker;
}

geometry_msgs::Point lifted(geometry_msgs::Point point, double z) {
  point.z += z;
  return point;
}

/// All points of a curve, at `step` [m] or more from each other, the ends included.
Points thinned(const Curve& curve, double step) {
  Points points;
  for (const CurveSegment& segment : curve.segment) {
    for (const geometry_msgs::Point& point : segment.line_segment.point) {
      const bool last = &point == &segment.line_segment.point.back();
      if (!points.empty() && !last &&
          std::hypot(point.x - points.back().x, point.y - points.back().y) < step) {
        continue;
      }
      points.push_back(point);
    }
  }
  return points;
}

/// Triangles between the borders; both are walked by their share of the whole length.
Marker fill_lane(const MapMsg& map, const Lane& lane, int id, const std_msgs::ColorRGBA& fill) {
  Marker marker = make_marker(map, "lanes", id, Marker::TRIANGLE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = fill;
  const Points left = thinned(lane.left_boundary.curve, kDrawStep);
  const Points right = thinned(lane.right_boundary.curve, kDrawStep);
  std::size_t l = 0, r = 0;
  while (l + 1 < left.size() || r + 1 < right.size()) {
    const bool advance_left =
        r + 1 == right.size() || (l + 1 < left.size() && (l + 1) * right.size() <= (r + 1) * left.size());
    const geometry_msgs::Point next = advance_left ? left[l + 1] : right[r + 1];
    marker.points.insert(marker.points.end(), {left[l], right[r], next});
    advance_left ? ++l : ++r;
  }
  return marker;
}

uint8_t first_type(const LaneBoundaryType& span) {
  if (span.types.empty()) return LaneBoundaryType::UNKNOWN;
  return span.types.front();
}

struct PaintStyle {
  std_msgs::ColorRGBA color;
  bool dashed;
  double width;  ///< [m]
};

PaintStyle style_of(uint8_t type) {
  const std_msgs::ColorRGBA white = color(1.0, 1.0, 1.0, 1.0), yellow = color(0.94, 0.89, 0.26, 1.0);
  switch (type) {
    case LaneBoundaryType::DOTTED_WHITE:
      return {white, true, 0.15};
    case LaneBoundaryType::SOLID_WHITE:
      return {white, false, 0.15};
    case LaneBoundaryType::DOTTED_YELLOW:
      return {yellow, true, 0.15};
    case LaneBoundaryType::SOLID_YELLOW:
      return {yellow, false, 0.15};
    case LaneBoundaryType::DOUBLE_YELLOW:
      return {yellow, false, 0.30};
    case LaneBoundaryType::CURB:
      return {kVermillion(), false, 0.20};
    default:
      return {color(0.70, 0.70, 0.75, 0.9), false, 0.06};
  }
}

/// One marker for each stretch of paint.
void draw_boundary(const MapMsg& map, const LaneBoundary& boundary, std::vector<Marker>& markers) {
  const Points points = thinned(boundary.curve, kDrawStep);
  for (std::size_t k = 0; k < boundary.boundary_type.size(); ++k) {
    const LaneBoundaryType& span = boundary.boundary_type[k];
    const double end =
        k + 1 < boundary.boundary_type.size() ? boundary.boundary_type[k + 1].s : boundary.length;
    const PaintStyle style = style_of(first_type(span));
    Marker marker = make_marker(map, "boundaries", static_cast<int>(markers.size()), Marker::LINE_LIST);
    marker.scale.x = style.width;
    marker.color = style.color;
    double s = 0.0;
    for (std::size_t i = 1; i < points.size(); ++i) {
      const bool gap = style.dashed && std::fmod(s, 2.0 * kDashLength) >= kDashLength;
      if (s >= span.s && s < end && !gap) {
        marker.points.push_back(lifted(points[i - 1], kBoundaryLift));
        marker.points.push_back(lifted(points[i], kBoundaryLift));
      }
      s += std::hypot(points[i].x - points[i - 1].x, points[i].y - points[i - 1].y);
    }
    if (!marker.points.empty()) markers.push_back(std::move(marker));
  }
}

/// What the camera saw, only as far as it saw it, in the frame and at the time of the image.
void draw_lane_marker(const MapMsg& map, const LaneMarker& seen, int id, std::vector<Marker>& markers) {
  const double length = seen.view_range - seen.longitude_start;
  if (!(seen.quality > 0.0) || !(length > 0.0 && length < 500.0)) return;
  Marker marker = make_marker(map, "lane_markers", id, Marker::LINE_STRIP);
  const std_msgs::Header& image = map.lane_marker.header;
  if (!image.frame_id.empty()) marker.header.frame_id = frame_name(image.frame_id);
  if (!image.stamp.isZero()) marker.header.stamp = image.stamp;
  marker.scale.x = 0.10;
  marker.color = kOrange();
  for (double x = seen.longitude_start; x <= seen.view_range; x += kDrawStep) {
    geometry_msgs::Point point;
    point.x = x;
    point.y = seen.c0_position +
              x * (seen.c1_heading_angle + x * (seen.c2_curvature + x * seen.c3_curvature_derivative));
    point.z = kMarkerLift;
    if (!std::isfinite(point.y)) return;
    marker.points.push_back(point);
  }
  if (marker.points.size() > 1) markers.push_back(std::move(marker));
}

Marker draw_centerline(const MapMsg& map, const Lane& lane) {
  Marker marker = make_marker(map, "centerline", 0, Marker::LINE_STRIP);
  marker.scale.x = 0.08;
  marker.color = kSky();
  for (const geometry_msgs::Point& point : thinned(lane.central_curve, kDrawStep)) {
    marker.points.push_back(lifted(point, kBoundaryLift));
  }
  return marker;
}

Marker draw_footprint(const MapMsg& map, const core::Footprint& footprint) {
  Marker marker = make_marker(map, "footprint", 0, Marker::LINE_STRIP);
  marker.scale.x = 0.05;
  marker.color = color(0.9, 0.9, 0.9, 1.0);
  const auto corner = [](double x, double y) {
    geometry_msgs::Point point;
    point.x = x;
    point.y = y;
    point.z = kMarkerLift;
    return point;
  };
  const double front = footprint.front_overhang, rear = -footprint.rear_overhang, half = footprint.half_width;
  marker.points = {corner(front, half), corner(front, -half), corner(rear, -half), corner(rear, half),
                   corner(front, half)};
  return marker;
}

Marker draw_status(const MapMsg& map) {
  Marker marker = make_marker(map, "status", 0, Marker::TEXT_VIEW_FACING);
  marker.pose.position.x = 1.5;
  marker.pose.position.z = 4.5;
  marker.scale.z = 0.7;
  if (map.status.code != MapStatus::OK) {
    marker.color = color(0.95, 0.1, 0.1, 1.0);
    marker.text = "NO MAP: " + map.status.message;
    return marker;
  }
  marker.color = color(0.5, 0.8, 0.9, 1.0);
  const char* source = map.fusion.source == FusionState::FUSED          ? "line + markers"
                       : map.fusion.source == FusionState::LANE_MARKERS ? "markers alone"
                                                                        : "line alone";
  marker.text = std::to_string(map.hdmap.lane.size()) + " lanes, " + source;
  return marker;
}

std_msgs::ColorRGBA fill_color(const MapMsg& map, const LaneNavigationPath& path) {
  if (path.lane_id == map.current_lane_id) return kBlue();
  return path.navigation_path.path_priority == 0 ? kTeal() : kGrey();
}

}  // namespace

visualization_msgs::MarkerArray MapMarkers::draw(const MapMsg& map, const core::Footprint& footprint) const {
  visualization_msgs::MarkerArray array;
  Marker clear = make_marker(map, "", 0, Marker::ARROW);
  clear.action = Marker::DELETEALL;
  array.markers.push_back(clear);

  std::vector<Marker> boundaries, seen;
  for (std::size_t i = 0; i < map.hdmap.lane.size(); ++i) {
    const Lane& lane = map.hdmap.lane[i];
    array.markers.push_back(
        fill_lane(map, lane, static_cast<int>(i), fill_color(map, map.navigation_path[i])));
    // A shared boundary is drawn once, by the lane on its right.
    if (lane.right_neighbor_forward_lane_id.empty()) draw_boundary(map, lane.right_boundary, boundaries);
    draw_boundary(map, lane.left_boundary, boundaries);
    if (lane.id == map.current_lane_id) array.markers.push_back(draw_centerline(map, lane));
  }
  // Paint that was not used may be of any age, and of any shape.
  if (map.fusion.marker_age >= 0.0) {
    draw_lane_marker(map, map.lane_marker.left_lane_marker, 0, seen);
    draw_lane_marker(map, map.lane_marker.right_lane_marker, 1, seen);
  }
  array.markers.insert(array.markers.end(), boundaries.begin(), boundaries.end());
  array.markers.insert(array.markers.end(), seen.begin(), seen.end());
  array.markers.push_back(draw_footprint(map, footprint));
  array.markers.push_back(draw_status(map));
  return array;
}

nav_msgs::Path centerline(const MapMsg& map) {
  nav_msgs::Path path;
  path.header = map.header;
  for (const LaneNavigationPath& lane : map.navigation_path) {
    if (lane.lane_id != map.current_lane_id) continue;
    for (const PathPoint& point : lane.navigation_path.path.path_point) {
      geometry_msgs::PoseStamped pose;
      pose.header = map.header;
      pose.pose.position.x = point.x;
      pose.pose.position.y = point.y;
      pose.pose.orientation.z = std::sin(0.5 * point.theta);
      pose.pose.orientation.w = std::cos(0.5 * point.theta);
      path.poses.push_back(pose);
    }
  }
  return path;
}

}  // namespace relative_map
