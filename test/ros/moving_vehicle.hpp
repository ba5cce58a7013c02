#pragma once

#include <gtest/gtest.h>

#include <string>

#include "ros/engine.hpp"

// A vehicle that turns, and map engines that it drives.
namespace relative_map::test {

const ros::Time kStamp(100.0);

/// An upright body on a plane in the map frame that turns.
struct Drive {
  Pose2 pose{Point2(442012.0, 4427003.0), 0.6};
  double speed = 8.0;     // [m/s] of base_link, forward
  double yaw_rate = 0.3;  // [rad/s]
};

/// A sensor that is off the axle, and turned about all axes.
inline Eigen::Isometry3d base_from_imu() {
  Eigen::Isometry3d transform = Eigen::Isometry3d::Identity();
  transform.translate(Eigen::Vector3d(1.2, -0.7, 0.9));
  transform.rotate(Eigen::AngleAxisd(2.0, Eigen::Vector3d(0.3, -0.5, 0.8).normalized()));
  return transform;
}

/// What a localization of the link says that is mounted so. Heading is left to the orientation.
inline LocalizationEstimate localization_of_link(const Drive& drive, const Eigen::Isometry3d& base_from_link,
                                                 const std::string& link) {
  Eigen::Isometry3d map_from_base = Eigen::Isometry3d::Identity();
  map_from_base.translate(Eigen::Vector3d(drive.pose.position().x(), drive.pose.position().y(), 20.0));
  map_from_base.rotate(yaw(drive.pose.heading()));
  const Eigen::Isometry3d map_from_link = map_from_base * base_from_link;
  const Eigen::Vector3d omega_base(0.0, 0.0, drive.yaw_rate);
  const Eigen::Vector3d velocity_base =
      Eigen::Vector3d(drive.speed, 0.0, 0.0) + omega_base.cross(base_from_link.translation());

  LocalizationEstimate message;
  message.header.stamp = kStamp;
  message.header.frame_id = "map";
  message.child_frame_id = link;
  set_xyz(message.pose.position, map_from_link.translation());
  message.pose.orientation = quaternion(Eigen::Quaterniond(map_from_link.rotation()));
  message.pose.heading = kNaN;
  set_xyz(message.pose.linear_velocity, map_from_base.rotation() * velocity_base);
  set_xyz(message.pose.angular_velocity_vrf, base_from_link.rotation().transpose() * omega_base);
  return message;
}

class MovingVehicleTest : public testing::Test {
 protected:
  explicit MovingVehicleTest(const NodeConfig& config = NodeConfig()) : engine(config) {
    engine.set_lines(three_lanes(drive.pose.to_parent(Pose2(Point2(-20.0, 0.4), 0.02))));
  }

  MapMsg map_of(const LocalizationEstimate& message) {
    engine->on_localization(shared(message), message.header.stamp);
    return engine.map_at(message.header.stamp);
  }

  MapMsg map_of_base_link() {
    return map_of(localization_of_link(drive, Eigen::Isometry3d::Identity(), "base_link"));
  }

  Drive drive;
  Engine engine;
};

/// Every vertex of every lane in the same place, seen from the vehicle.
inline void expect_same_lanes(const MapMsg& a, const MapMsg& b, std::size_t lanes, double tolerance) {
  ASSERT_EQ(a.navigation_path.size(), lanes) << a.status.message;
  ASSERT_EQ(b.navigation_path.size(), lanes) << b.status.message;
  EXPECT_EQ(a.current_lane_id, b.current_lane_id);
  for (std::size_t lane = 0; lane < lanes; ++lane) {
    const auto& from = a.navigation_path[lane].navigation_path.path.path_point;
    const auto& to = b.navigation_path[lane].navigation_path.path.path_point;
    ASSERT_EQ(from.size(), to.size());
    for (std::size_t i = 0; i < from.size(); ++i) {
      EXPECT_NEAR(from[i].x, to[i].x, tolerance);
      EXPECT_NEAR(from[i].y, to[i].y, tolerance);
    }
  }
}

}  // namespace relative_map::test
