#include "relative_map/ros/view/boundary_markers.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/ros/view/marker_shapes.hpp"

namespace relative_map {

namespace {

using visualization_msgs::Marker;

constexpr double kDashLength = 3.0;                  // [m] of a dotted line, and of the gap after it
constexpr double kRim = 0.05;                        // [m] on each side of paint
constexpr double kRimLift = 0.02, kLineLift = 0.04;  // [m] above the lanes

uint8_t first_type(const LaneBoundaryType& span) {
  if (span.types.empty()) return LaneBoundaryType::UNKNOWN;
  return span.types.front();
}

struct PaintStyle {
  std_msgs::ColorRGBA color;
  bool dashed;
  double width;        ///< [m]
  double apart = 0.0;  ///< [m] between the two lines of double paint
};

PaintStyle style_of(uint8_t type) {
  const std_msgs::ColorRGBA white = color(1.0, 1.0, 1.0), yellow = color(0.94, 0.89, 0.26);
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
      return {yellow, false, 0.12, 0.30};
    case LaneBoundaryType::CURB:
      return {color(0.84, 0.37, 0.0), false, 0.25};
    default:
      return {color(0.55, 0.55, 0.60), false, 0.06};
  }
}

}  // namespace

void BoundaryMarkers::add_rim(const MapMsg& map, const Marker& paint) {
  const double width = paint.scale.x + 2.0 * kRim;
  auto rim = std::find_if(rims_.begin(), rims_.end(),
                          [&](const Marker& other) { return std::abs(other.scale.x - width) < 1e-6; });
  if (rim == rims_.end()) {
    Marker first = make_marker(map, "boundary_rims", static_cast<int>(rims_.size()), Marker::LINE_LIST);
    first.scale.x = width;
    first.color = color(0.10, 0.10, 0.12);
    rim = rims_.insert(rims_.end(), first);
  }
  for (geometry_msgs::Point point : paint.points) {
    point.z += kRimLift - kLineLift;
    rim->points.push_back(point);
  }
}

void BoundaryMarkers::add(const MapMsg& map, const LaneBoundary& boundary, double remaining_distance) {
  const Points points = thinned(boundary.curve);
  // The line's end, far away, is a large number away; only its place within a dash counts.
  const double phase = -std::fmod(s_beside_vehicle(points) + remaining_distance, 2.0 * kDashLength);
  for (std::size_t k = 0; k < boundary.boundary_type.size(); ++k) {
    const LaneBoundaryType& span = boundary.boundary_type[k];
    const bool last = k + 1 == boundary.boundary_type.size();
    const double end = last ? boundary.length : boundary.boundary_type[k + 1].s;
    const uint8_t type = first_type(span);
    const PaintStyle style = style_of(type);
    Marker marker = make_marker(map, "boundaries", static_cast<int>(markers_.size()), Marker::LINE_LIST);
    marker.scale.x = style.width;
    marker.color = style.color;
    if (boundary.is_virtual) marker.color.a = 0.4f;
    const Dashes dashes{style.dashed ? kDashLength : 0.0, phase};
    if (style.apart > 0.0) {
      for (const double side : {0.5, -0.5}) {
        append_stroke(shifted(points, side * style.apart), span.s, end, dashes, kLineLift, marker.points);
      }
    } else {
      append_stroke(points, span.s, end, dashes, kLineLift, marker.points);
    }
    if (marker.points.empty()) continue;
    if (type != LaneBoundaryType::UNKNOWN) add_rim(map, marker);
    markers_.push_back(std::move(marker));
  }
}

}  // namespace relative_map
