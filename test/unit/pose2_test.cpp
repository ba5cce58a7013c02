#include "relative_map/geometry/pose2.hpp"

#include <gtest/gtest.h>

namespace relative_map::core {
namespace {

const Point2 kUtm(691191.9668313662, 3118215.5540518095);

TEST(Pose2, TurnsTheMapSoThatTheHeadingIsX) {
  const Pose2 north(Point2(10.0, 20.0), kPi / 2.0);
  EXPECT_NEAR((north.to_local(Point2(10.0, 25.0)) - Point2(5.0, 0.0)).norm(), 0.0, 1e-15) << "ahead";
  EXPECT_NEAR((north.to_local(Point2(7.0, 20.0)) - Point2(0.0, 3.0)).norm(), 0.0, 1e-15) << "to the left";
  EXPECT_NEAR((north.to_parent(Point2(5.0, 1.0)) - Point2(9.0, 25.0)).norm(), 0.0, 1e-15);
}

TEST(Pose2, RotatesVectorsWithoutMovingThem) {
  const Pose2 pose(kUtm, 0.3);
  const Point2 ahead(std::cos(0.3), std::sin(0.3));
  EXPECT_NEAR((pose.rotate_to_local(ahead) - Point2::UnitX()).norm(), 0.0, 1e-15);
  EXPECT_NEAR((pose.rotate_to_parent(Point2::UnitX()) - ahead).norm(), 0.0, 1e-15);
  EXPECT_NEAR((pose.rotate_to_parent(Point2::UnitY()) - left_of(ahead)).norm(), 0.0, 1e-15);
}

TEST(Pose2, KeepsTheDigitsOfMapSizedCoordinates) {
  // Both points lie on the grid of doubles, so their difference is exact, and only the rotation rounds.
  const Pose2 pose(kUtm, 1.5147908243102891);
  const Point2 offset(0.125, -0.25);
  const Point2 local = pose.to_local(kUtm + offset);
  const double c = std::cos(pose.heading()), s = std::sin(pose.heading());
  EXPECT_NEAR(local.x(), c * 0.125 - s * 0.25, 1e-15);
  EXPECT_NEAR(local.y(), -s * 0.125 - c * 0.25, 1e-15);
}

TEST(Pose2, IsUndoneByItsInverse) {
  const Pose2 pose(kUtm, -2.5);
  const Point2 point(123.4, -56.7);
  EXPECT_NEAR((pose.to_local(pose.to_parent(point)) - point).norm(), 0.0, 1e-9);
}

TEST(Pose2, ChainsWithOtherPoses) {
  const Pose2 a(Point2(1.0, 2.0), 3.0), b(Point2(4.0, -5.0), 0.5);
  const Pose2 chained = a.to_parent(b);
  EXPECT_NEAR(chained.heading(), 3.5 - 2.0 * kPi, 1e-15);
  const Point2 point(0.7, 0.8);
  EXPECT_NEAR((chained.to_parent(point) - a.to_parent(b.to_parent(point))).norm(), 0.0, 1e-14);
  const Pose2 back = a.to_local(chained);
  EXPECT_NEAR((back.position() - b.position()).norm(), 0.0, 1e-14);
  EXPECT_NEAR(back.heading(), 0.5, 1e-15);
}

TEST(CrossProduct, IsPositiveToTheLeft) {
  EXPECT_EQ(cross(Point2::UnitX(), Point2::UnitY()), 1.0);
  EXPECT_EQ(cross(Point2::UnitX(), left_of(Point2::UnitX())), 1.0);
}

}  // namespace
}  // namespace relative_map::core
