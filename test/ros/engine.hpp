#pragma once

#include <geometry_msgs/TransformStamped.h>
#include <gtest/gtest.h>
#include <tf2/buffer_core.h>

#include <string>

#include "relative_map/ros/map/map_engine.hpp"
#include "ros/messages.hpp"

namespace relative_map::test {

/// A map engine with static transforms of its own.
class Engine {
 public:
  explicit Engine(const NodeConfig& config = NodeConfig()) : engine_(config, link_transforms(transforms_)) {}

  MapEngine* operator->() { return &engine_; }

  void set_lines(const NavigationInfo& lines) {
    engine_.set_navigation_lines(MapEngine::prepare(lines, engine_.config()));
  }

  /// Where `child` is mounted on `parent`.
  void mount(const std::string& parent, const std::string& child,
             const Eigen::Isometry3d& parent_from_child) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = parent;
    transform.child_frame_id = child;
    set_xyz(transform.transform.translation, parent_from_child.translation());
    transform.transform.rotation = quaternion(Eigen::Quaterniond(parent_from_child.rotation()));
    transforms_.setTransform(transform, "test", true);
  }

  /// The map of a tick, which must give one; an empty message and a failure otherwise.
  MapMsg map_at(const ros::Time& now) {
    const MapMsgPtr map = engine_.tick(now);
    if (map) return *map;
    ADD_FAILURE() << "no map at " << now;
    return MapMsg();
  }

  /// base_link at `pose`.
  void drive_to(const Pose2& pose, const ros::Time& stamp) {
    engine_.on_localization(shared(localization(pose, stamp)), stamp);
  }

 private:
  tf2::BufferCore transforms_;
  MapEngine engine_;
};

}  // namespace relative_map::test
