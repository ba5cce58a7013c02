#include "relative_map/ros/setup/urdf_frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <urdf/model.h>

#include <stdexcept>

namespace relative_map {

void add_urdf_frames(const std::string& urdf, tf2::BufferCore& transforms) {
  urdf::Model model;
  if (!model.initString(urdf)) throw std::runtime_error("the robot description is no valid URDF");
  for (const auto& [unused, joint] : model.joints_) {
    geometry_msgs::TransformStamped transform;
    transform.header.frame_id = joint->parent_link_name;
    transform.child_frame_id = joint->child_link_name;
    const urdf::Pose& pose = joint->parent_to_joint_origin_transform;
    transform.transform.translation.x = pose.position.x;
    transform.transform.translation.y = pose.position.y;
    transform.transform.translation.z = pose.position.z;
    pose.rotation.getQuaternion(transform.transform.rotation.x, transform.transform.rotation.y,
                                transform.transform.rotation.z, transform.transform.rotation.w);
    transforms.setTransform(transform, "urdf", true);
  }
}

}  // namespace relative_map
