#include "relative_map/ros/messages/message_check.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

constexpr char kNavigationPath[] = "navigation_path";
constexpr char kCentralCurve[] = "central_curve";
constexpr char kLaneType[] = "lane_type";

/// Exactly one path for each lane.
std::string navigation_path_fault(const MapMsg& map) {
  if (map.navigation_path.size() != map.hdmap.lane.size()) {
    return std::to_string(map.navigation_path.size()) + " paths for " +
           std::to_string(map.hdmap.lane.size()) + " lanes";
  }
  for (const Lane& lane : map.hdmap.lane) {
    const auto paths = std::count_if(map.navigation_path.begin(), map.navigation_path.end(),
                                     [&](const LaneNavigationPath& path) { return path.lane_id == lane.id; });
    if (paths != 1) return "lane '" + lane.id + "' has " + std::to_string(paths) + " paths";
  }
  return "";
}

/// The curve of a lane and the path of the same lane are one and the same line.
std::string central_curve_fault(const MapMsg& map) {
  for (const Lane& lane : map.hdmap.lane) {
    const auto path = std::find_if(map.navigation_path.begin(), map.navigation_path.end(),
                                   [&](const LaneNavigationPath& p) { return p.lane_id == lane.id; });
    if (path == map.navigation_path.end()) continue;
    const std::vector<PathPoint>& points = path->navigation_path.path.path_point;
    std::size_t i = 0;
    for (const CurveSegment& segment : lane.central_curve.segment) {
      for (const geometry_msgs::Point& point : segment.line_segment.point) {
        if (i == points.size()) return "the curve of lane '" + lane.id + "' has more points than its path";
        const double gap = std::hypot(point.x - points[i].x, point.y - points[i].y);
        if (!(gap < 1e-6)) {
          return "the curve of lane '" + lane.id + "' leaves its path at point " + std::to_string(i);
        }
        ++i;
      }
    }
    if (i != points.size()) return "the curve of lane '" + lane.id + "' has fewer points than its path";
  }
  return "";
}

std::string lane_type_fault(const MapMsg& map) {
  for (const Lane& lane : map.hdmap.lane) {
    if (lane.type != Lane::CITY_DRIVING)
      return "lane '" + lane.id + "' has type " + std::to_string(lane.type);
  }
  return "";
}

}  // namespace

std::vector<std::string> message_check_rows() {
  return {kNavigationPath, kCentralCurve, kLaneType};
}

std::vector<core::Violation> check_message(const MapMsg& message, const core::MapContext& context) {
  std::vector<core::Violation> violations = core::check_map(to_core(message), context);
  const auto add = [&](const char* row, const std::string& fault) {
    if (!fault.empty()) violations.push_back({row, fault});
  };
  add(kNavigationPath, navigation_path_fault(message));
  add(kCentralCurve, central_curve_fault(message));
  add(kLaneType, lane_type_fault(message));
  return violations;
}

}  // namespace relative_map
