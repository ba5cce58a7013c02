#include <gtest/gtest.h>

#include "relative_map/pipeline/navigation_lines.hpp"
#include "support/lines.hpp"

// How laps are recognised and stitched.
namespace relative_map::core {
namespace {

using test::arc;
using test::recording;
using test::straight;

NavigationLine prepare(const Polyline& points, bool stitch_closed_lines = true) {
  IntakeParam param;
  param.stitch_closed_lines = stitch_closed_lines;
  const auto prepared = prepare_navigation_lines({"map", {recording(points)}}, param);
  EXPECT_EQ(prepared->lines.size(), 1u);
  EXPECT_TRUE(prepared->faults.empty());
  return prepared->lines.at(0);
}

/// s rises all round, over the seam too, and no step is longer than `max_step` or nearly nothing.
void expect_even_steps(const NavigationLine& line, double max_step) {
  ASSERT_TRUE(line.closed());
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const bool seam = i + 1 == line.points.size();
    const PathPoint& a = line.points[i];
    const PathPoint& b = line.points[seam ? 0 : i + 1];
    const double ds = (seam ? line.length : b.s) - a.s;
    EXPECT_NEAR(ds, (b.position - a.position).norm(), 1e-9);
    EXPECT_LT(ds, max_step) << "point " << i;
    EXPECT_GT(ds, 0.25 * max_step / 1.5) << "point " << i;
  }
}

void expect_no_kink(const NavigationLine& line, double max_turn) {
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const PathPoint& a = line.points[i];
    const PathPoint& b = line.points[(i + 1) % line.points.size()];
    EXPECT_LT(std::abs(angle_difference(b.theta, a.theta)), max_turn) << "point " << i;
  }
}

TEST(ClosedLines, ACircleRecordedAsALapClosesWithConstantCurvature) {
  for (const bool ends_on_its_start : {false, true}) {
    Polyline points = test::circle(30.0, 190);
    if (ends_on_its_start) points.push_back(points.front());
    const NavigationLine line = prepare(points);
    expect_even_steps(line, 1.5);
    EXPECT_EQ(line.points.size(), 190u);
    EXPECT_NEAR(line.length, 190.0 * 60.0 * std::sin(kPi / 190.0), 1e-9);
    for (const PathPoint& point : line.points) {
      EXPECT_NEAR(point.kappa, 1.0 / 30.0, 1e-9);
      EXPECT_NEAR(point.dkappa, 0.0, 1e-9);
    }
  }
}

TEST(ClosedLines, StayOpenWhereCyclicReroutingIsOff) {
  EXPECT_FALSE(prepare(test::circle(30.0, 190), false).closed());
}

TEST(ClosedLines, ClockwiseLapsCloseToo) {
  Polyline points = test::circle(30.0, 190);
  std::reverse(points.begin(), points.end());
  const NavigationLine line = prepare(points);
  expect_even_steps(line, 1.5);
  for (const PathPoint& point : line.points) EXPECT_NEAR(point.kappa, -1.0 / 30.0, 1e-9);
}

TEST(ClosedLines, OpenLinesAreNeverClosed) {
  for (const double length : {1.0, 10.0, 29.0, 35.0, 100.0, 400.0, 600.0}) {
    EXPECT_FALSE(prepare(straight(Pose2(), length, 0.5)).closed()) << length << " m straight";
    EXPECT_FALSE(prepare(arc(Pose2(), 2.0 / length, length, 0.5)).closed()) << length << " m curve";
  }
}

TEST(ClosedLines, AUTurnBesideItsStartIsNotClosed) {
  Polyline points = straight(Pose2(), 100.0, 0.5);
  const Polyline turn = arc(Pose2(Point2(100.5, 0.0), 0.0), 1.0, 3.1, 0.5);
  const Polyline back = straight(Pose2(Point2(100.0, 1.6), kPi), 100.0, 0.5);
  points.insert(points.end(), turn.begin(), turn.end());
  points.insert(points.end(), back.begin(), back.end());
  EXPECT_FALSE(prepare(points).closed()) << "it ends 1.6 m beside its start, but runs the other way";
}

TEST(ClosedLines, ALapThatLacksItsLastMetresIsNotClosed) {
  const Polyline most = arc(Pose2(), 1.0 / 60.0, 2.0 * kPi * 60.0 - 8.0, 0.5);
  EXPECT_FALSE(prepare(most).closed()) << "the gap of 8 m is no vertex spacing";
}

TEST(ClosedLines, ALapInTheNextLaneIsNotClosed) {
  // A spiral that ends one lane beside its start.
  Polyline points;
  for (int i = 0; i <= 800; ++i) {
    const double t = i / 800.0;
    points.push_back((60.0 + 3.5 * t) * Point2(std::cos(2.0 * kPi * t), std::sin(2.0 * kPi * t)));
  }
  EXPECT_FALSE(prepare(points).closed());
}

/// A circle of 60 m radius whose end lies `error` [m] outside of its start.
Polyline drifting_lap(double error) {
  Polyline points;
  for (int i = 0; i < 800; ++i) {
    const double t = i / 800.0;
    points.push_back((60.0 + error * t) * Point2(std::cos(2.0 * kPi * t), std::sin(2.0 * kPi * t)));
  }
  return points;
}

TEST(ClosedLines, AClosingErrorIsSpreadSmoothly) {
  for (const double error : {0.5, -0.5, 1.5}) {
    const Polyline points = drifting_lap(error);
    const NavigationLine line = prepare(points);
    expect_even_steps(line, 0.75);
    expect_no_kink(line, 0.015);  // of which the circle itself has 0.008
    for (const PathPoint& point : line.points) {
      EXPECT_NEAR(point.kappa, 1.0 / 60.0, 0.012 * std::abs(error)) << "no kink at s = " << point.s;
      const double from_center = (line.origin + point.position).norm();
      EXPECT_GT(from_center, 59.9 + std::min(0.0, error));
      EXPECT_LT(from_center, 60.1 + std::max(0.0, error));
    }
    EXPECT_NEAR((line.origin + line.points.back().position).norm(), 60.0, 0.01) << "the seam is closed";
    EXPECT_EQ(line.origin + line.points[400].position, points[400]) << "far from the seam nothing moves";
  }
}

TEST(ClosedLines, LoseWhatRunsPastTheStart) {
  for (const double overlap : {0.3, 1.0, 5.0, 40.0, 200.0}) {
    const double lap = 2.0 * kPi * 60.0;
    const NavigationLine line = prepare(arc(Pose2(), 1.0 / 60.0, lap + overlap, 0.5));
    expect_even_steps(line, 0.85);
    EXPECT_NEAR(line.length, lap, 0.01) << "with an overlap of " << overlap << " m";
    expect_no_kink(line, 0.02);
  }
}

TEST(ClosedLines, ALoopThatGoesOnElsewhereIsNotClosed) {
  // Round once and then off along the tangent.
  Polyline points = arc(Pose2(), 1.0 / 60.0, 2.0 * kPi * 60.0, 0.5);
  const Polyline off = straight(Pose2(points.back() + Point2(0.5, 0.0), 0.0), 100.0, 0.5);
  points.insert(points.end(), off.begin(), off.end());
  EXPECT_FALSE(prepare(points).closed());
}

TEST(ClosedLines, SparselyRecordedLapsCloseToo) {
  const NavigationLine line = prepare(test::circle(40.0, 60));  // 4.2 m from point to point
  expect_even_steps(line, 6.0);
  EXPECT_EQ(line.points.size(), 60u);
}

TEST(ClosedLines, GetGeometryOfTheirOwnPastTheSeam) {
  RecordedLine lap = recording(test::circle(30.0, 190));
  for (std::size_t i = 0; i < lap.points.size(); ++i) {
    lap.points[i].theta = normalize_angle(kPi / 2.0 + 2.0 * kPi * static_cast<double>(i) / 190.0 + 0.001);
    lap.points[i].kappa = 1.0 / 30.0;
  }
  const auto prepared = prepare_navigation_lines({"map", {lap}}, IntakeParam());
  const NavigationLine& line = prepared->lines.at(0);
  EXPECT_NEAR(line.points.front().theta, kPi / 2.0, 1e-9);
  EXPECT_NEAR(line.points.back().theta, kPi / 2.0 - 2.0 * kPi / 190.0, 1e-9);
}

}  // namespace
}  // namespace relative_map::core
