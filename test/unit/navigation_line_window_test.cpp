#include "relative_map/pipeline/lanes/navigation_line_window.hpp"

#include <gtest/gtest.h>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using test::prepared;
using test::straight;
using test::vehicle_at;

const Point2 kUtm(691191.9668313662, 3118215.5540518095);

LanePath window_at(const NavigationLine& line, const Pose2& pose, double max_length) {
  NavigationLineTracker tracker;
  const auto tracked = tracker.track(line, vehicle_at(pose), 15.0);
  return cut_window(line, std::get<LineProjection>(tracked), pose, max_length);
}

TEST(Window, StartsThreeVerticesBeforeTheNearestAndEndsWithTheFirstPastItsLength) {
  const LanePath path =
      window_at(prepared(straight(Pose2(), 500.0, 0.5)), Pose2(Point2(100.1, 0.7), 0.0), 250.0);
  EXPECT_NEAR(path.points.front().position.x(), 98.5 - 100.1, 1e-12);
  EXPECT_NEAR(path.points.front().position.y(), -0.7, 1e-12);
  EXPECT_EQ(path.points.front().s, 0.0);
  EXPECT_NEAR(path.points.back().s, 250.5, 1e-9) << "the first one past 250 m";
  EXPECT_EQ(path.points.size(), 502u);
  EXPECT_NEAR(path.s_at_vehicle, 1.6, 1e-12);
  EXPECT_NEAR(path.l, 0.7, 1e-12);
  EXPECT_NEAR(path.remaining, 399.9, 1e-12);
}

TEST(Window, HoldsTheLinesOwnVerticesSeenFromTheVehicle) {
  const Pose2 start(kUtm, 2.0);
  const Pose2 vehicle = start.to_parent(Pose2(Point2(120.0, -1.0), 0.3));
  const NavigationLine line = prepared(test::arc(start, 0.001, 400.0, 0.4));
  const LanePath path = window_at(line, vehicle, 100.0);
  std::size_t i = 0;
  while (i < line.points.size() &&
         (vehicle.to_local(line.origin + line.points[i].position) - path.points[0].position).norm() > 0.1) {
    ++i;
  }
  for (std::size_t k = 0; k < path.points.size(); ++k) {
    ASSERT_LT(i + k, line.points.size());
    const PathPoint& vertex = line.points[i + k];
    const PathPoint& point = path.points[k];
    EXPECT_NEAR((point.position - vehicle.to_local(line.origin + vertex.position)).norm(), 0.0, 1e-9);
    EXPECT_NEAR(point.theta, angle_difference(vertex.theta, vehicle.heading()), 1e-12);
    EXPECT_NEAR((point.direction - Point2(std::cos(point.theta), std::sin(point.theta))).norm(), 0.0, 1e-12);
    EXPECT_EQ(point.kappa, vertex.kappa) << "a curvature is the same in any frame";
    EXPECT_EQ(point.dkappa, vertex.dkappa);
    EXPECT_NEAR(point.s, vertex.s - line.points[i].s, 1e-12);
  }
}

/// 50 m out along x, and back on the same points.
NavigationLine there_and_back() {
  Polyline points = straight(Pose2(), 50.0, 1.0);
  const Polyline back = straight(Pose2(Point2(49.0, 0.0), kPi), 49.0, 1.0);
  points.insert(points.end(), back.begin(), back.end());
  return prepared(points);
}

TEST(Window, EndsWhereTheLineTurnsBack) {
  const LanePath out = window_at(there_and_back(), Pose2(Point2(30.0, 0.0), 0.0), 250.0);
  EXPECT_NEAR(out.points.back().position.x(), 20.0, 1e-9);
  EXPECT_NEAR(out.remaining, 20.0, 1e-9) << "what can be driven";
  for (const PathPoint& point : out.points) {
    EXPECT_NEAR(point.theta, 0.0, 1e-12) << "of the way out alone";
    EXPECT_NEAR(point.kappa, 0.0, 1e-12);
  }
}

TEST(Window, BeginsWhereTheLineTurnsBack) {
  const LanePath back = window_at(there_and_back(), Pose2(Point2(48.9, 0.0), kPi), 250.0);
  EXPECT_NEAR(back.points.front().position.x(), -1.1, 1e-9);
  EXPECT_NEAR(back.points.back().position.x(), 48.9, 1e-9);
  EXPECT_NEAR(back.s_at_vehicle, 1.1, 1e-9);
  EXPECT_NEAR(back.points.front().theta, 0.0, 1e-9);
}

TEST(Window, BesideATurnBackHasTheSideThatTheVehicleIsOn) {
  for (const double heading : {0.0, kPi}) {
    const LanePath path = window_at(there_and_back(), Pose2(Point2(49.8, 0.0), heading), 250.0);
    EXPECT_NEAR(path.points.front().position.x(), heading == 0.0 ? -2.8 : -0.2, 1e-9);
    EXPECT_NEAR(path.points.back().position.x(), heading == 0.0 ? 0.2 : 49.8, 1e-9);
  }
}

TEST(Window, EndsAtATurnBackThatLiesJustPastItsLength) {
  const LanePath path = window_at(there_and_back(), Pose2(Point2(30.0, 0.0), 0.0), 22.5);
  EXPECT_NEAR(path.points.back().position.x(), 20.0, 1e-9);
  EXPECT_NEAR(path.points.back().theta, 0.0, 1e-12);
}

TEST(Window, NeverReachesBeyondAnOpenLine) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  const LanePath at_start = window_at(line, Pose2(Point2(0.2, 0.0), 0.0), 250.0);
  EXPECT_EQ(at_start.points.size(), 101u);
  EXPECT_NEAR(at_start.s_at_vehicle, 0.2, 1e-12);
  const LanePath at_end = window_at(line, Pose2(Point2(99.9, 0.0), 0.0), 250.0);
  EXPECT_EQ(at_end.points.size(), 4u) << "what is left, down to the last metre";
  EXPECT_NEAR(at_end.remaining, 0.1, 1e-12);
}

TEST(Window, BeforeAnOpenLineHasTheVehicleBehindItsStart) {
  const LanePath path =
      window_at(prepared(straight(Pose2(), 100.0, 1.0)), Pose2(Point2(-6.0, 1.0), 0.0), 50.0);
  EXPECT_NEAR(path.points.front().position.x(), 6.0, 1e-12);
  EXPECT_NEAR(path.s_at_vehicle, -6.0, 1e-12);
}

TEST(Window, GoesOnAcrossTheStitch) {
  const NavigationLine lap = prepared(test::circle(60.0, 400));
  const double chord = lap.length / 400.0;
  for (const double driven : {-20.0, -2.1, -0.2, 0.2, 1.0, 2.1, 20.0}) {  // from the seam
    const Pose2 pose = test::along_arc(Pose2(Point2(60.0, 0.0), kPi / 2.0), 1.0 / 60.0, driven);
    const LanePath path = window_at(lap, pose, 100.0);
    EXPECT_NEAR(path.points.back().s, 100.0, 1.0);
    EXPECT_NEAR(path.s_at_vehicle, 3.0 * chord, 0.55 * chord) << driven << " m past the seam";
    for (std::size_t i = 0; i < path.points.size(); ++i) {
      EXPECT_NEAR(path.points[i].s, static_cast<double>(i) * chord, 1e-9);
      EXPECT_NEAR(path.points[i].kappa, 1.0 / 60.0, 1e-9);
      const double ahead = path.points[i].s - path.s_at_vehicle;
      const Pose2 truth = test::along_arc(Pose2(), 1.0 / 60.0, ahead);
      EXPECT_NEAR((path.points[i].position - truth.position()).norm(), 0.0, 0.01);
    }
  }
}

TEST(Window, GoesRoundARoundaboutAsOftenAsItsLengthNeeds) {
  const double radius = 190.0 / (2.0 * kPi);
  const NavigationLine lap = prepared(test::circle(radius, 380));
  const LanePath path = window_at(lap, Pose2(Point2(radius, 0.0), kPi / 2.0), 250.0);
  EXPECT_GT(path.points.back().s, 250.0);
  EXPECT_EQ(path.points.size(), 502u);
  for (std::size_t i = 1; i < path.points.size(); ++i) EXPECT_GT(path.points[i].s, path.points[i - 1].s);
  EXPECT_NEAR((path.points[0].position - path.points[380].position).norm(), 0.0, 1e-9) << "a lap later";
  EXPECT_NEAR(path.points[380].s, lap.length, 1e-9);
}

TEST(Window, OfAThinnedLineReachesTwoMetresBack) {
  Polyline points;
  for (int i = 0; i <= 20; ++i) points.push_back(Point2(0.1 * i, 0.0));  // dense at first
  for (int i = 1; i <= 20; ++i) points.push_back(Point2(2.0 + 5.0 * i, 0.0));
  for (int i = 1; i <= 100; ++i) points.push_back(Point2(102.0 + 0.1 * i, 0.0));
  const NavigationLine line = prepared(points);
  ASSERT_TRUE(line.thinned);
  const LanePath dense = window_at(line, Pose2(Point2(110.0, 0.0), 0.0), 50.0);
  EXPECT_NEAR(dense.points.front().position.x(), -2.0, 0.11);
  const LanePath sparse = window_at(line, Pose2(Point2(52.0, 0.0), 0.0), 50.0);
  EXPECT_NEAR(sparse.points.front().position.x(), -15.0, 1e-9) << "three vertices are farther already";
}

}  // namespace
}  // namespace relative_map::core
