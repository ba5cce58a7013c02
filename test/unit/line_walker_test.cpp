#include "relative_map/pipeline/lines/line_walker.hpp"

#include <gtest/gtest.h>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using test::prepared;

TEST(LineWalker, TellsThePlaceBesideAStraight) {
  const NavigationLine line = prepared(test::straight(Pose2(), 100.0, 0.7));
  LineWalker walker(line, 0);
  for (double x = 0.0; x < 90.0; x += 1.3) {
    const BesideLine beside = walker.beside(Point2(x, -2.0) - line.origin);
    EXPECT_TRUE(beside.exists);
    EXPECT_NEAR(beside.s, x, 1e-9);
    EXPECT_NEAR(beside.lateral, -2.0, 1e-9);
    EXPECT_NEAR(beside.normal.y(), 1.0, 1e-9);
  }
}

TEST(LineWalker, GoesBackAndFarAheadInOneCall) {
  const NavigationLine line = prepared(test::straight(Pose2(), 100.0, 0.7));
  LineWalker walker(line, 50);
  for (const double x : {90.0, 3.0, 77.7}) {
    EXPECT_NEAR(walker.beside(Point2(x, 1.0) - line.origin).s, x, 1e-9);
  }
}

TEST(LineWalker, BeyondTheEndsThereIsNoLine) {
  const NavigationLine line = prepared(test::straight(Pose2(), 20.0, 1.0));
  LineWalker walker(line, 10);
  EXPECT_FALSE(walker.beside(Point2(22.0, 1.0) - line.origin).exists);
  EXPECT_FALSE(walker.beside(Point2(-2.0, 1.0) - line.origin).exists);
  EXPECT_TRUE(walker.beside(Point2(19.9, 1.0) - line.origin).exists);
}

TEST(LineWalker, GoesRoundALapAcrossTheStitch) {
  const double radius = 50.0;
  const NavigationLine line = prepared(test::circle(radius, 700));
  ASSERT_TRUE(line.closed());
  LineWalker walker(line, 690);
  for (double angle = -0.2; angle < 6.5; angle += 0.05) {
    const BesideLine beside =
        walker.beside((radius - 1.5) * Point2(std::cos(angle), std::sin(angle)) - line.origin);
    EXPECT_TRUE(beside.exists);
    EXPECT_NEAR(beside.lateral, 1.5, 2e-3) << angle;  // chords lie inside their arcs
    EXPECT_NEAR(std::remainder(beside.s - radius * angle, line.length), 0.0, 0.02) << angle;
  }
}

}  // namespace
}  // namespace relative_map::core
