#include "relative_map/ros/view/map_markers.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/view/boundary_markers.hpp"
#include "relative_map/ros/view/marker_shapes.hpp"

namespace relative_map {

namespace {

using visualization_msgs::Marker;

constexpr double kRawDashLength = 1.0;  // [m]
constexpr std::size_t kMaxText = 90;    // characters: more do not fit on a screen
constexpr double kTextHeight = 0.9;     // [m]
// [m] What was seen is drawn above what was made of it.
constexpr double kLineLift = 0.04, kMarkerLift = 0.06;

std_msgs::ColorRGBA priority_color(uint32_t priority, double a) {
  switch (priority) {
    case 0:
      return color(0.00, 0.50, 0.85, a);  // blue
    case 1:
      return color(0.00, 0.65, 0.48, a);  // bluish green
    case 2:
      return color(0.75, 0.42, 0.65, a);  // purple
    default:
      return color(0.55, 0.55, 0.60, a);  // grey
  }
}

/// Triangles between the borders; both are walked by their share of the whole length.
Marker fill_lane(const MapMsg& map, const Lane& lane, int id, const std_msgs::ColorRGBA& fill) {
  Marker marker = make_marker(map, "lanes", id, Marker::TRIANGLE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
  marker.color = fill;
  const Points left = thinned(lane.left_boundary.curve);
  const Points right = thinned(lane.right_boundary.curve);
  std::size_t l = 0, r = 0;
  while (l + 1 < left.size() || r + 1 < right.size()) {
    const bool advance_left =
        r + 1 == right.size() || (l + 1 < left.size() && (l + 1) * right.size() <= (r + 1) * left.size());
    const geometry_msgs::Point next = advance_left ? left[l + 1] : right[r + 1];
    marker.points.insert(marker.points.end(), {left[l], right[r], next});
    advance_left ? ++l : ++r;
  }
  // A colour for each corner, and rviz leaves its light off: else a lane is dark that is seen from behind.
  marker.colors.assign(marker.points.size(), fill);
  return marker;
}

/// What the camera saw, only as far as it saw it, in the frame and at the time of the image.
void draw_lane_marker(const MapMsg& map, const LaneMarker& seen, int id, std::vector<Marker>& markers) {
  const double length = seen.view_range - seen.longitude_start;
  if (!(seen.quality > 0.0) || !(length > 0.0 && length < 500.0)) return;
  Marker marker = make_marker(map, "lane_markers", id, Marker::LINE_STRIP);
  const std_msgs::Header& image = map.lane_marker.header;
  if (!image.frame_id.empty()) marker.header.frame_id = frame_name(image.frame_id);
  if (!image.stamp.isZero()) marker.header.stamp = image.stamp;
  marker.scale.x = 0.07;  // paint below it stays in sight
  marker.color = color(0.95, 0.62, 0.0);
  for (double x = seen.longitude_start; x <= seen.view_range; x += 1.0) {
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

/// As recorded, with the same dashes as if it lay on the road: they stand still.
Marker draw_raw_line(const MapMsg& map, const core::Polyline& line, double remaining_distance) {
  Marker marker = make_marker(map, "navigation_line", 0, Marker::LINE_LIST);
  marker.scale.x = 0.07;  // on top of the centerline, both are seen
  marker.color = color(0.90, 0.20, 0.60);
  Curve curve;
  curve.segment.resize(1);
  for (const core::Point2& position : line) {
    geometry_msgs::Point point;
    point.x = position.x();
    point.y = position.y();
    curve.segment[0].line_segment.point.push_back(point);
  }
  const Points points = thinned(curve);
  const double phase = -std::fmod(s_beside_vehicle(points) + remaining_distance, 2.0 * kRawDashLength);
  append_stroke(points, 0.0, 1e9, {kRawDashLength, phase}, kMarkerLift, marker.points);
  return marker;
}

Marker draw_centerline(const MapMsg& map, const Lane& lane) {
  Marker marker = make_marker(map, "centerline", 0, Marker::LINE_STRIP);
  marker.scale.x = 0.12;
  marker.color = color(0.80, 0.95, 1.0);
  marker.points = thinned(lane.central_curve);
  for (geometry_msgs::Point& point : marker.points) point.z += kLineLift;
  return marker;
}

/// Light in a dark rim, for any background.
void draw_footprint(const MapMsg& map, const core::Footprint& footprint, std::vector<Marker>& markers) {
  const auto corner = [](double x, double y, double z) {
    geometry_msgs::Point point;
    point.x = x;
    point.y = y;
    point.z = z;
    return point;
  };
  const double front = footprint.front_overhang, rear = -footprint.rear_overhang, half = footprint.half_width;
  for (const bool rim : {true, false}) {
    Marker marker = make_marker(map, "footprint", rim ? 1 : 0, Marker::LINE_STRIP);
    marker.frame_locked = true;  // goes with the vehicle, not with the map
    marker.scale.x = rim ? 0.14 : 0.06;
    marker.color = rim ? color(0.10, 0.10, 0.12) : color(1.0, 1.0, 1.0);
    const double z = rim ? kLineLift : kMarkerLift;
    marker.points = {corner(front, half, z), corner(front, -half, z), corner(rear, -half, z),
                     corner(rear, half, z), corner(front, half, z)};
    markers.push_back(std::move(marker));
  }
}

/// What fits on one line.
std::string one_line(std::string text) {
  std::replace_if(
      text.begin(), text.end(), [](unsigned char c) { return c < ' '; }, ' ');
  if (text.size() <= kMaxText) return text;
  std::size_t end = kMaxText - 3;
  while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U)
    --end;  // within a UTF-8 character
  return text.substr(0, end) + "...";
}

/// [m] y of what lies farthest to the left near the vehicle.
double left_edge(const MapMsg& map) {
  double edge = 0.0;
  for (const CurveSegment& segment : map.hdmap.lane.front().left_boundary.curve.segment) {
    for (const geometry_msgs::Point& point : segment.line_segment.point) {
      if (std::abs(point.x) < 25.0) edge = std::max(edge, std::min(point.y, 25.0));
    }
  }
  return edge;
}

/// Beside the road, where no lane is behind it. Its colours stand out by as much from black as from white.
Marker draw_status(const MapMsg& map) {
  Marker marker = make_marker(map, "status", 0, Marker::TEXT_VIEW_FACING);
  marker.pose.position.x = 18.0;
  marker.pose.position.z = 0.5;
  marker.scale.z = kTextHeight;
  marker.frame_locked = true;
  if (map.status.code != MapStatus::OK) {
    marker.color = color(0.95, 0.15, 0.10);
    marker.text = one_line("NO MAP: " + map.status.message);
    return marker;
  }
  marker.color = color(0.0, 0.52, 0.88);
  const char* source = map.fusion.source == FusionState::FUSED          ? "line + markers"
                       : map.fusion.source == FusionState::LANE_MARKERS ? "markers alone"
                                                                        : "line alone";
  const std::size_t count = map.hdmap.lane.size();
  if (count == 0) return marker;  // a status that is wrong
  marker.text = std::to_string(count) + (count == 1 ? " lane, " : " lanes, ") + source;
  marker.pose.position.y =
      left_edge(map) + 1.0 + 0.25 * kTextHeight * static_cast<double>(marker.text.size());
  return marker;
}

std_msgs::ColorRGBA fill_color(const MapMsg& map, const LaneNavigationPath& path) {
  return priority_color(path.navigation_path.path_priority,
                        path.lane_id == map.current_lane_id ? 0.85 : 0.40);
}

}  // namespace

visualization_msgs::MarkerArray MapMarkers::draw(const MapMsg& map, const core::Footprint& footprint,
                                                 const core::Polyline& raw_line) const {
  visualization_msgs::MarkerArray array;
  Marker clear = make_marker(map, "", 0, Marker::ARROW);
  clear.action = Marker::DELETEALL;
  array.markers.push_back(clear);

  BoundaryMarkers boundaries;
  std::vector<Marker> others;
  for (std::size_t i = 0; i < map.hdmap.lane.size(); ++i) {
    const Lane& lane = map.hdmap.lane[i];
    const LaneNavigationPath& path = map.navigation_path[i];
    array.markers.push_back(fill_lane(map, lane, static_cast<int>(i), fill_color(map, path)));
    // A shared boundary is drawn once, by the lane on its right.
    if (lane.right_neighbor_forward_lane_id.empty()) {
      boundaries.add(map, lane.right_boundary, path.remaining_distance);
    }
    boundaries.add(map, lane.left_boundary, path.remaining_distance);
    if (lane.id != map.current_lane_id) continue;
    if (raw_line.size() > 1) others.push_back(draw_raw_line(map, raw_line, path.remaining_distance));
    others.push_back(draw_centerline(map, lane));
  }
  // Paint that was not used may be of any age, and of any shape.
  if (map.fusion.marker_age >= 0.0) {
    draw_lane_marker(map, map.lane_marker.left_lane_marker, 0, others);
    draw_lane_marker(map, map.lane_marker.right_lane_marker, 1, others);
  }
  draw_footprint(map, footprint, others);
  others.push_back(draw_status(map));
  const auto append = [&](const std::vector<Marker>& markers) {
    array.markers.insert(array.markers.end(), markers.begin(), markers.end());
  };
  append(boundaries.rims());
  append(boundaries.markers());
  append(others);
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
