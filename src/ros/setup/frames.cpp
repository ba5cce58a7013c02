#include "relative_map/ros/setup/frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

namespace relative_map {

LinkTransforms link_transforms(const tf2::BufferCore& buffer) {
  return [&buffer](const std::string& target, const std::string& source) -> std::optional<Eigen::Isometry3d> {
    if (target == source) return Eigen::Isometry3d::Identity();
    try {
      // Time zero: static transforms hold at all times.
      const geometry_msgs::Transform found = buffer.lookupTransform(target, source, ros::Time(0)).transform;
      Eigen::Isometry3d target_from_source = Eigen::Isometry3d::Identity();
      target_from_source.translate(
          Eigen::Vector3d(found.translation.x, found.translation.y, found.translation.z));
      target_from_source.rotate(
          Eigen::Quaterniond(found.rotation.w, found.rotation.x, found.rotation.y, found.rotation.z)
              .normalized());
      return target_from_source;
    } catch (const tf2::TransformException&) {
      return std::nullopt;
    }
  };
}

}  // namespace relative_map
