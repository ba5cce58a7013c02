#include "relative_map/ros/setup/frames.hpp"

#include <geometry_msgs/TransformStamped.h>
#include <tf2/exceptions.h>

#include <cmath>

namespace relative_map {

namespace {

constexpr double kLongestSilence =
    1.5;                          // [s] on /tf: publishers of fixed links repeat them once a second or more
constexpr double kWatched = 0.5;  // [s] that a link on /tf must have been the same
constexpr double kLookedBack = 5.0;      // [s] for when it was not
constexpr double kLookStep = 0.25;       // [s]
constexpr double kSamePlace = 1e-3;      // [m] numbers on the way through other software differ by less
constexpr double kSameDirection = 1e-3;  // [rad]

std::optional<geometry_msgs::TransformStamped> look_up(const tf2::BufferCore& buffer,
                                                       const std::string& target, const std::string& source,
                                                       const ros::Time& at) {
  try {
    return buffer.lookupTransform(target, source, at);
  } catch (const tf2::TransformException&) {
    return std::nullopt;
  }
}

Eigen::Isometry3d to_eigen(const geometry_msgs::Transform& transform) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translate(
      Eigen::Vector3d(transform.translation.x, transform.translation.y, transform.translation.z));
  result.rotate(Eigen::Quaterniond(transform.rotation.w, transform.rotation.x, transform.rotation.y,
                                   transform.rotation.z)
                    .normalized());
  return result;
}

bool same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  return (a.translation() - b.translation()).norm() < kSamePlace &&
         Eigen::AngleAxisd(a.rotation().transpose() * b.rotation()).angle() < kSameDirection;
}

/// [s] As numbers: a difference of times throws where it is more than 68 years, as of a stamp that is scrap.
double seconds_between(const ros::Time& from, const ros::Time& to) {
  return to.toSec() - from.toSec();
}

/// Whether the way between two links has been the same up to `newest`, for long enough to tell.
bool stands_still(const tf2::BufferCore& buffer, const std::string& target, const std::string& source,
                  const ros::Time& newest, const Eigen::Isometry3d& now) {
  for (double back = kLookStep; back <= kLookedBack; back += kLookStep) {
    if (newest.toSec() <= back) return back > kWatched;
    const auto before = look_up(buffer, target, source, newest - ros::Duration(back));
    if (!before) return back > kWatched;
    if (!same(to_eigen(before->transform), now)) return false;
  }
  return true;
}

bool is_finite(const geometry_msgs::Transform& transform) {
  const auto& q = transform.rotation;
  const double squares = q.x * q.x + q.y * q.y + q.z * q.z + q.w * q.w;
  return std::isfinite(transform.translation.x + transform.translation.y + transform.translation.z) &&
         std::isfinite(squares) && squares > 1e-6;
}

}  // namespace

LinkTransforms link_transforms(const tf2::BufferCore& buffer) {
  return [&buffer](const std::string& target, const std::string& source,
                   const ros::Time& at) -> std::optional<Eigen::Isometry3d> {
    if (target == source) return Eigen::Isometry3d::Identity();
    const auto newest = look_up(buffer, target, source, ros::Time(0));
    if (!newest) return std::nullopt;
    const Eigen::Isometry3d target_from_source = to_eigen(newest->transform);
    const ros::Time stamp = newest->header.stamp;
    if (stamp.isZero()) return target_from_source;  // all of it is static
    if (seconds_between(stamp, at) > kLongestSilence) return std::nullopt;
    if (!stands_still(buffer, target, source, stamp, target_from_source)) return std::nullopt;
    return target_from_source;
  };
}

void add_transforms(const tf2_msgs::TFMessage& message, bool is_static, tf2::BufferCore& buffer) {
  for (const geometry_msgs::TransformStamped& transform : message.transforms) {
    if (!is_finite(transform.transform) || (!is_static && transform.header.stamp.isZero())) continue;
    buffer.setTransform(transform, is_static ? "/tf_static" : "/tf", is_static);
  }
}

}  // namespace relative_map
