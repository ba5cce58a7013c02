#pragma once

#include <ros/time.h>
#include <tf2/buffer_core.h>
#include <tf2_msgs/TFMessage.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>

// Where the links of a vehicle are on it. They are mounted: what moves is not a place of the vehicle.
namespace relative_map {

/// target_from_source between two links of the vehicle, for a measurement of time `at`; none if it is not
/// known.
using LinkTransforms = std::function<std::optional<Eigen::Isometry3d>(
    const std::string& target, const std::string& source, const ros::Time& at)>;

/// Looks links up in `buffer`, which must outlive the result. Identity where target is source. What comes on
/// /tf_static holds for ever. What comes on /tf (as from old static_transform_publishers) is known once it
/// has stayed the same for half a second, and only until 1.5 s after its newest message: a link that moves,
/// or whose publisher is dead, is none.
LinkTransforms link_transforms(const tf2::BufferCore& buffer);

/// Puts a message of /tf_static or of /tf into `buffer`, live as out of a bag. What has no stamp on /tf, or
/// numbers that are none, is left out.
void add_transforms(const tf2_msgs::TFMessage& message, bool is_static, tf2::BufferCore& buffer);

}  // namespace relative_map
