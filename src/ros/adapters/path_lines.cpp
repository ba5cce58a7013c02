#include "relative_map/ros/adapters/path_lines.hpp"

#include <algorithm>
#include <limits>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

/// A planner that sends its path again and again gives no new line.
bool same_way(const nav_msgs::Path& a, const nav_msgs::Path& b) {
  return frame_name(a.header.frame_id) == frame_name(b.header.frame_id) &&
         std::equal(a.poses.begin(), a.poses.end(), b.poses.begin(), b.poses.end(),
                    [](const geometry_msgs::PoseStamped& p, const geometry_msgs::PoseStamped& q) {
                      return p.pose.position.x == q.pose.position.x && p.pose.position.y == q.pose.position.y;
                    });
}

}  // namespace

PathLines::Answer PathLines::add(const std::string& topic, const nav_msgs::Path& path) {
  for (const auto& [other, known] : paths_) {
    if (other == topic || path.poses.empty()) continue;
    if (frame_name(known.header.frame_id) != frame_name(path.header.frame_id)) {
      return {std::nullopt, topic + ": is in frame '" + frame_name(path.header.frame_id) + "', but " + other +
                                " in '" + frame_name(known.header.frame_id) + "': it is not used"};
    }
  }
  const auto before = paths_.find(topic);
  if (path.poses.empty()) {
    if (before == paths_.end()) return {};
    paths_.erase(before);
    return {all(), ""};
  }
  if (before != paths_.end() && same_way(before->second, path)) return {};
  paths_[topic] = path;
  return {all(), ""};
}

NavigationInfo PathLines::all() const {
  constexpr double kNotGiven = std::numeric_limits<double>::quiet_NaN();
  NavigationInfo info;
  for (std::size_t i = 0; i < topics_.size(); ++i) {
    const auto path = paths_.find(topics_[i]);
    if (path == paths_.end()) continue;
    if (info.navigation_path.empty()) info.header = path->second.header;
    info.header.stamp = std::max(info.header.stamp, path->second.header.stamp);
    NavigationPath line;
    line.path.name = topics_[i];
    line.path_priority = static_cast<uint32_t>(i);
    for (const geometry_msgs::PoseStamped& pose : path->second.poses) {
      PathPoint point;
      point.x = pose.pose.position.x;
      point.y = pose.pose.position.y;
      point.z = pose.pose.position.z;
      point.theta = point.kappa = point.dkappa = point.ddkappa = point.s = kNotGiven;
      line.path.path_point.push_back(point);
    }
    info.navigation_path.push_back(std::move(line));
  }
  info.header.frame_id = frame_name(info.header.frame_id);
  return info;
}

}  // namespace relative_map
