#include <gtest/gtest.h>

#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "support/vehicles.hpp"

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
  for (const std::string& fault : prepared->faults) {  // some of these turns are sharper than any lane's
    EXPECT_NE(fault.find("turns back"), std::string::npos) << fault;
  }
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

/// [1/m] the greatest change of curvature from one vertex to the next, round the lap.
double roughest_step(const NavigationLine& line) {
  double roughest = 0.0;
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    const double step = line.points[(i + 1) % line.points.size()].kappa - line.points[i].kappa;
    roughest = std::max(roughest, std::abs(step));
  }
  return roughest;
}

TEST(ClosedLines, AnyClosingErrorUpToALanesHalfWidthIsSmooth) {
  for (double error = -1.75; error <= 1.75; error += 0.25) {
    const NavigationLine line = prepare(drifting_lap(error));
    expect_even_steps(line, 0.75);
    EXPECT_EQ(line.points.size(), 800u) << "no point is missing or doubled";
    expect_no_kink(line, 0.015);
    EXPECT_LT(roughest_step(line), 0.002 * std::abs(error) + 1e-9) << "closing error " << error << " m";
  }
  EXPECT_FALSE(prepare(drifting_lap(1.8)).closed()) << "the ends do not meet within a half width";
}

TEST(ClosedLines, AClosingErrorAlongTheLapIsAGapOrAnOverlapOfVertices) {
  for (double along = -1.2; along <= 1.7; along += 0.2) {  // short of its start, or past it
    const NavigationLine line = prepare(arc(Pose2(), 1.0 / 60.0, 2.0 * kPi * 60.0 + along, 0.5));
    ASSERT_TRUE(line.closed()) << along;
    EXPECT_NEAR(line.length, 2.0 * kPi * 60.0, 0.01);
    expect_no_kink(line, 0.04);  // over the longest step, of 1.7 m and one spacing
    for (const PathPoint& point : line.points) EXPECT_NEAR(point.kappa, 1.0 / 60.0, 1e-6);
  }
}

Polyline joined(std::initializer_list<Polyline> pieces) {
  Polyline points;
  for (const Polyline& piece : pieces) points.insert(points.end(), piece.begin(), piece.end());
  return points;
}

TEST(ClosedLines, HairpinsAreNotClosed) {
  for (const double radius : {0.5, 0.8, 3.0, 6.0}) {
    for (const double leg : {2.0, 10.0, 40.0, 150.0}) {
      const Polyline hairpin = joined({straight(Pose2(), leg, 0.4),
                                       arc(Pose2(Point2(leg, 0.0), 0.0), 1.0 / radius, kPi * radius, 0.4),
                                       straight(Pose2(Point2(leg, 2.0 * radius), kPi), leg, 0.4)});
      EXPECT_FALSE(prepare(hairpin).closed()) << radius << " m radius, legs of " << leg << " m";
    }
  }
}

TEST(ClosedLines, LassosAreNotClosed) {
  // Out, once round, and back on the way out to where it began; and the same without the way back.
  for (const double radius : {5.0, 15.0, 40.0}) {
    for (const double rope : {3.0, 20.0, 100.0}) {
      const Polyline out = straight(Pose2(), rope, 0.4);
      const Polyline round = arc(Pose2(Point2(rope, 0.0), 0.0), 1.0 / radius, 2.0 * kPi * radius, 0.4);
      const Polyline back = straight(Pose2(Point2(rope - 0.4, 0.0), kPi), rope - 0.4, 0.4);
      const std::string words = std::to_string(rope) + " m to a circle of " + std::to_string(radius) + " m";
      EXPECT_FALSE(test::prepared(joined({out, round, back})).closed()) << words << " and back";
      // From 3 m on the side of a wide circle it is a lap that runs past its start.
      if (rope > 3.0) {
        EXPECT_FALSE(test::prepared(joined({out, round})).closed()) << words;
      }
    }
  }
}

TEST(ClosedLines, ShortLinesOfAnyShapeAreNotClosed) {
  for (const double length : {0.5, 2.0, 10.0, 25.0}) {
    for (const double turns : {0.0, 0.5, 0.9, 1.0, 1.02, 2.0}) {
      const double kappa = 2.0 * kPi * turns / length;
      EXPECT_FALSE(prepare(arc(Pose2(), kappa, length, length / 40.0)).closed())
          << length << " m, round " << turns << " times: no vehicle drives so tight a lap";
    }
  }
}

TEST(ClosedLines, EndsThatMeetAtAnAngleDoNotMakeALap) {
  // A drop: out along x, round, and back to the start from aside.
  for (const double turn : {0.8, 1.2, 1.6}) {
    Polyline drop = straight(Pose2(), 60.0, 0.5);
    const double radius = 60.0 * std::tan(0.5 * turn);
    const Polyline bend = arc(Pose2(Point2(60.0, 0.0), 0.0), 1.0 / radius, radius * (kPi + turn), 0.5);
    drop.insert(drop.end(), bend.begin(), bend.end());
    for (double back = 0.5; back < 60.0; back += 0.5) {
      drop.push_back(Pose2(Point2::Zero(), turn).to_parent(Point2(60.0 - back, 0.0)));
    }
    EXPECT_FALSE(prepare(drop).closed()) << turn;
  }
}

}  // namespace
}  // namespace relative_map::core
