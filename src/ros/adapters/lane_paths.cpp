#include "relative_map/ros/adapters/lane_paths.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map {

namespace {

const Lane* find_lane(const MapMsg& map, const std::string& id) {
  const auto found = std::find_if(map.hdmap.lane.begin(), map.hdmap.lane.end(),
                                  [&](const Lane& lane) { return lane.id == id; });
  return found == map.hdmap.lane.end() ? nullptr : &*found;
}

nav_msgs::Path path_of(const std_msgs::Header& header, const Curve& curve) {
  nav_msgs::Path path;
  path.header = header;
  for (const CurveSegment& segment : curve.segment) {
    for (const geometry_msgs::Point& point : segment.line_segment.point) {
      geometry_msgs::PoseStamped pose;
      pose.header = header;
      pose.pose.position = point;
      pose.pose.orientation.w = 1.0;
      path.poses.push_back(pose);
    }
  }
  for (std::size_t i = 0; i + 1 < path.poses.size(); ++i) {
    const geometry_msgs::Point &from = path.poses[i].pose.position, &to = path.poses[i + 1].pose.position;
    const double half = 0.5 * std::atan2(to.y - from.y, to.x - from.x);
    path.poses[i].pose.orientation.z = std::sin(half);
    path.poses[i].pose.orientation.w = std::cos(half);
  }
  if (path.poses.size() > 1)
    path.poses.back().pose.orientation = path.poses[path.poses.size() - 2].pose.orientation;
  return path;
}

}  // namespace

std::map<std::string, nav_msgs::Path> lane_paths(const MapMsg& map) {
  std::map<std::string, nav_msgs::Path> paths;
  const auto add = [&](const Lane& lane, const std::string& place) {
    paths[place + "/centerline"] = path_of(map.header, lane.central_curve);
    paths[place + "/left_border"] = path_of(map.header, lane.left_boundary.curve);
    paths[place + "/right_border"] = path_of(map.header, lane.right_boundary.curve);
  };
  const Lane* current = find_lane(map, map.current_lane_id);
  if (!current) return paths;
  add(*current, "current");
  const auto add_side = [&](const std::string& side, auto neighbors) {
    const Lane* lane = current;
    // No more steps than lanes: a map that breaks its contract must not hold us.
    for (std::size_t i = 1; i < map.hdmap.lane.size(); ++i) {
      const std::vector<std::string>& next = (*lane).*neighbors;
      lane = next.empty() ? nullptr : find_lane(map, next.front());
      if (!lane) return;
      add(*lane, side + "_" + std::to_string(i));
    }
  };
  add_side("left", &Lane::left_neighbor_forward_lane_id);
  add_side("right", &Lane::right_neighbor_forward_lane_id);
  return paths;
}

}  // namespace relative_map
