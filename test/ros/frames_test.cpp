// What counts as a place on the vehicle: static, or on /tf and standing still.
#include "relative_map/ros/setup/frames.hpp"

#include <gtest/gtest.h>

#include "ros/messages.hpp"

namespace relative_map {
namespace {

using test::quaternion;
using test::set_xyz;
using test::yaw;

tf2_msgs::TFMessage link(double stamp, double x, double angle = 0.0) {
  tf2_msgs::TFMessage message;
  message.transforms.resize(1);
  geometry_msgs::TransformStamped& transform = message.transforms[0];
  transform.header.stamp = ros::Time(stamp);
  transform.header.frame_id = "base_link";
  transform.child_frame_id = "camera";
  set_xyz(transform.transform.translation, {x, 0.2, 1.0});
  transform.transform.rotation = quaternion(yaw(angle));
  return message;
}

class Links : public testing::Test {
 protected:
  std::optional<Eigen::Isometry3d> camera_at(double time) const {
    return link_transforms(buffer)("base_link", "camera", ros::Time(time));
  }

  tf2::BufferCore buffer;
};

TEST_F(Links, AreKnownToThemselves) {
  EXPECT_TRUE(link_transforms(buffer)("base_link", "base_link", ros::Time(1.0)));
  EXPECT_FALSE(camera_at(1.0));
}

TEST_F(Links, HoldForEverWhereTheyAreStatic) {
  add_transforms(link(0.0, 1.5), true, buffer);
  for (const double time : {0.0, 1.0, 1.7e9}) {
    ASSERT_TRUE(camera_at(time)) << time;
    EXPECT_DOUBLE_EQ(camera_at(time)->translation().x(), 1.5);
  }
}

TEST_F(Links, OnTfAreKnownOnceTheyHaveStoodStillForAWhile) {
  add_transforms(link(100.0, 1.5), false, buffer);
  EXPECT_FALSE(camera_at(100.0)) << "one message may be of something that moves";
  for (int i = 1; i <= 10; ++i) add_transforms(link(100.0 + 0.1 * i, 1.5), false, buffer);
  ASSERT_TRUE(camera_at(101.0));
  EXPECT_DOUBLE_EQ(camera_at(101.0)->translation().x(), 1.5);
}

/// Old static_transform_publishers stamp one period ahead, and send once a second at the slowest.
TEST_F(Links, OnTfMayBeRareAndAhead) {
  for (int i = 0; i < 4; ++i) add_transforms(link(100.0 + i, 1.5), false, buffer);
  for (const double time : {102.1, 103.0, 104.3}) EXPECT_TRUE(camera_at(time)) << time;
}

TEST_F(Links, OnTfAreForgottenWhenTheirPublisherIsDead) {
  for (int i = 0; i <= 20; ++i) add_transforms(link(100.0 + 0.1 * i, 1.5), false, buffer);
  EXPECT_TRUE(camera_at(103.0));
  EXPECT_FALSE(camera_at(104.0));
  EXPECT_FALSE(camera_at(1.7e9));
}

TEST_F(Links, ThatMoveAreNoPlaceOnTheVehicle) {
  for (const double speed : {0.05, 1.0, 10.0}) {
    buffer.clear();
    for (int i = 0; i <= 20; ++i) add_transforms(link(100.0 + 0.1 * i, speed * 0.1 * i), false, buffer);
    EXPECT_FALSE(camera_at(102.0)) << speed;
  }
  buffer.clear();
  for (int i = 0; i <= 20; ++i) add_transforms(link(100.0 + 0.1 * i, 1.5, 0.01 * i), false, buffer);
  EXPECT_FALSE(camera_at(102.0)) << "turns";
}

TEST_F(Links, AreNoneAsSoonAsTheyBeginToMove) {
  for (int i = 0; i <= 40; ++i) add_transforms(link(100.0 + 0.1 * i, 1.5), false, buffer);
  ASSERT_TRUE(camera_at(104.0));
  add_transforms(link(104.1, 1.52), false, buffer);
  EXPECT_FALSE(camera_at(104.1));
  for (int i = 1; i <= 20; ++i) add_transforms(link(104.1 + 0.1 * i, 1.52), false, buffer);
  EXPECT_FALSE(camera_at(106.1)) << "it may move on";
}

TEST_F(Links, WithoutAStampOrWithBadNumbersAreLeftOut) {
  add_transforms(link(0.0, 1.5), false, buffer);
  EXPECT_FALSE(camera_at(0.0));
  add_transforms(link(0.0, test::kNaN), true, buffer);
  EXPECT_FALSE(camera_at(0.0));
  tf2_msgs::TFMessage unturned = link(0.0, 1.0);
  unturned.transforms[0].transform.rotation.w = 0.0;
  add_transforms(unturned, true, buffer);
  EXPECT_FALSE(camera_at(0.0));
}

TEST_F(Links, StayWhereTheyAreStaticWhenTheRestIsForgotten) {
  add_transforms(link(0.0, 1.5), true, buffer);
  buffer.clear();
  EXPECT_TRUE(camera_at(5.0));
}

}  // namespace
}  // namespace relative_map
