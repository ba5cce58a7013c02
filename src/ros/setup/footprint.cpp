#include "relative_map/ros/setup/footprint.hpp"

#include <urdf/model.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace relative_map {

namespace {

Eigen::Isometry3d to_eigen(const urdf::Pose& pose) {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(Eigen::Vector3d(pose.position.x, pose.position.y, pose.position.z));
  transform.rotate(Eigen::Quaterniond(pose.rotation.w, pose.rotation.x, pose.rotation.y, pose.rotation.z));
  return transform;
}

/// Half extents along the base's axes of a primitive that is turned so; zero for meshes, which are not read.
Eigen::Vector3d reach(const urdf::Geometry& geometry, const Eigen::Matrix3d& base_from_shape) {
  switch (geometry.type) {
    case urdf::Geometry::BOX: {
      const urdf::Vector3& size = static_cast<const urdf::Box&>(geometry).dim;
      return 0.5 * base_from_shape.cwiseAbs() * Eigen::Vector3d(size.x, size.y, size.z);
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = static_cast<const urdf::Cylinder&>(geometry);
      const Eigen::Array3d axis = base_from_shape.col(2).array().abs();
      // The ends are discs: along their axis they have no extent, square to it that of their radius.
      return 0.5 * cylinder.length * axis + cylinder.radius * (1.0 - axis.square()).max(0.0).sqrt();
    }
    case urdf::Geometry::SPHERE:
      return Eigen::Vector3d::Constant(static_cast<const urdf::Sphere&>(geometry).radius);
    default:
      return Eigen::Vector3d::Zero();
  }
}

void extend(Eigen::AlignedBox3d& box, const urdf::Link& link, const Eigen::Isometry3d& base_from_link) {
  for (const auto& collision : link.collision_array) {
    if (!collision || !collision->geometry) continue;
    const Eigen::Isometry3d base_from_shape = base_from_link * to_eigen(collision->origin);
    const Eigen::Vector3d half = reach(*collision->geometry, base_from_shape.rotation());
    if (half.isZero()) continue;
    box.extend(base_from_shape.translation() - half);
    box.extend(base_from_shape.translation() + half);
  }
  for (const auto& child : link.child_links) {
    if (child->parent_joint->type != urdf::Joint::FIXED) continue;
    extend(box, *child, base_from_link * to_eigen(child->parent_joint->parent_to_joint_origin_transform));
  }
}

/// base_from_root along fixed joints, and the link that the fixed part of the tree starts at.
Eigen::Isometry3d climb_to_root(urdf::LinkConstSharedPtr& link) {
  Eigen::Isometry3d root_from_base = Eigen::Isometry3d::Identity();
  while (link->getParent() && link->parent_joint->type == urdf::Joint::FIXED) {
    root_from_base = to_eigen(link->parent_joint->parent_to_joint_origin_transform) * root_from_base;
    link = link->getParent();
  }
  return root_from_base.inverse();
}

/// By its name, or by what follows a tf prefix: 'car1/base_link' is the URDF's 'base_link'.
urdf::LinkConstSharedPtr find_link(const urdf::Model& model, const std::string& name) {
  const urdf::LinkConstSharedPtr link = model.getLink(name);
  const std::size_t slash = name.rfind('/');
  return link || slash == std::string::npos ? link : model.getLink(name.substr(slash + 1));
}

}  // namespace

core::Footprint footprint_from_urdf(const std::string& urdf, const std::string& base_frame) {
  urdf::Model model;
  if (!model.initString(urdf)) throw std::runtime_error("robot_description is no valid URDF");
  urdf::LinkConstSharedPtr link = find_link(model, base_frame);
  if (!link) throw std::runtime_error("robot_description has no link '" + base_frame + "'");
  Eigen::AlignedBox3d box;
  const Eigen::Isometry3d base_from_root = climb_to_root(link);
  extend(box, *link, base_from_root);
  if (box.isEmpty()) {
    throw std::runtime_error("robot_description has no collision box, cylinder or sphere fixed to '" +
                             base_frame + "': the vehicle's footprint is unknown");
  }
  core::Footprint footprint;
  footprint.half_width = std::max(box.max().y(), -box.min().y());
  footprint.front_overhang = std::max(0.0, box.max().x());
  footprint.rear_overhang = std::max(0.0, -box.min().x());
  return footprint;
}

}  // namespace relative_map
