#include "relative_map/tools/line_edit.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/simulation/noise.hpp"
#include "relative_map/simulation/road.hpp"
#include "support/editable_lines.hpp"
#include "support/lines.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::editable;
using test::fault_of;
using test::lap;
using testing::HasSubstr;

TEST(LineEdit, ACircleIsALoopAndAnArcIsNot) {
  EXPECT_TRUE(lap(20.0, 200).closed());
  EXPECT_FALSE(editable(test::arc({}, 0.05, 100.0, 0.5)).closed());
  EXPECT_FALSE(lap(3.0, 40).closed());  // too short for a lap
  Polyline again = test::circle(20.0, 200);
  again.push_back(again.front());
  const EditableLine line = editable(again);
  EXPECT_TRUE(line.closed());
  EXPECT_EQ(line.points.size(), 200u);
  EXPECT_EQ(make_recorded(line).points.size(), 201u);
  EXPECT_NEAR(length_of(line), 2.0 * kPi * 20.0, 0.02);
}

TEST(LineEdit, ResamplesEvenlyOnTheCurve) {
  const EditableLine line = resample(editable(test::arc({}, 0.05, 40.0, 2.0)), 0.5);
  EXPECT_EQ(line.points.size(), 81u);
  for (const Point2& point : line.points) EXPECT_NEAR((point - Point2(0.0, 20.0)).norm(), 20.0, 1e-3);
  EXPECT_NEAR((line.points.back() - test::along_arc({}, 0.05, 40.0).position()).norm(), 0.0, 1e-9);
  const EditableLine loop = resample(lap(20.0, 100), 0.5);
  EXPECT_TRUE(loop.closed());
  EXPECT_NEAR(loop.closing_length(), 0.5, 0.01);
}

TEST(LineEdit, ResamplesByCurvature) {
  RoadShape road;
  road.add_straight(100.0).add_arc(50.0, 0.004).add_arc(50.0, 0.01).add_arc(50.0, 0.05).add_straight(100.0);
  const EditableLine line =
      resample_by_curvature(make_editable(road.lane(0.0, 0.1)), default_curvature_spacing());
  const PathPoints path = path_of(line);
  std::size_t hint = 0;
  const auto spacing_at = [&](double s) {
    interpolate(path, s, hint);
    return path[hint + 1].s - path[hint].s;
  };
  EXPECT_NEAR(spacing_at(50.0), 3.0, 1e-3);
  EXPECT_NEAR(spacing_at(125.0), 1.0, 1e-3);
  EXPECT_NEAR(spacing_at(175.0), 0.4, 1e-3);
  EXPECT_NEAR(spacing_at(225.0), 0.1, 1e-3);
  EXPECT_NEAR(spacing_at(300.0), 3.0, 1e-3);
  EXPECT_NEAR(path.back().s, 350.0, 0.02);
  for (double s = 200.0; s < 249.0; s += 1.0) EXPECT_LT(spacing_at(s), 0.11) << s;
}

TEST(LineEdit, ClosesALapThatOverlapsOrFallsShort) {
  for (double lap_share : {0.97, 1.0, 1.1}) {
    SCOPED_TRACE(lap_share);
    Polyline points = test::arc({}, 0.02, lap_share * 100.0 * kPi, 0.5);
    for (std::size_t i = 0; i < points.size(); ++i) {  // drifts by a metre
      points[i] += Point2(0.0, 1.0 * static_cast<double>(i) / static_cast<double>(points.size()));
    }
    const EditableLine line = close(editable(points), 10.0);
    ASSERT_TRUE(line.closed());
    EXPECT_NEAR(length_of(line), 100.0 * kPi, 3.0);
    for (const PathPoint& point : path_of(line)) {
      EXPECT_GT(point.kappa, -0.02) << point.s;
      EXPECT_LT(point.kappa, 0.06) << point.s;
    }
    EXPECT_TRUE(make_editable(make_recorded(line)).closed());
  }
}

TEST(LineEdit, ClosesANoisyLapWhichStaysALoop) {
  for (double noise : {0.2, 0.5, 1.0}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      SCOPED_TRACE(testing::Message() << noise << ", " << seed);
      Polyline points = test::arc({}, 0.01, 660.0, 1.5);  // 32 m past the start
      NoiseSource source(seed, 1);
      for (Point2& point : points) point += Point2(source.draw(noise), source.draw(noise));
      const EditableLine line = close(editable(points), 5.0);
      ASSERT_TRUE(line.closed());
      EXPECT_TRUE(make_editable(make_recorded(line)).closed());
      const double shares = static_cast<double>(line.points.size()) * 1.5 / (200.0 * kPi);
      EXPECT_NEAR(shares, 1.0, 0.02);
    }
  }
}

TEST(LineEdit, WhatDoesNotMeetCannotBeClosed) {
  EXPECT_THAT(fault_of([] { close(editable(test::straight({}, 200.0, 1.0)), 5.0); }),
              HasSubstr("the ends are 200.00 m apart"));
  EXPECT_THAT(fault_of([] { close(editable(test::straight({}, 20.0, 1.0)), 5.0); }), HasSubstr("too short"));
}

TEST(LineEdit, ReversedTwiceIsTheSame) {
  const EditableLine line = editable(test::arc({}, 0.02, 50.0, 0.5));
  EXPECT_EQ(reverse(reverse(line)).points, line.points);
  EXPECT_NEAR(path_of(reverse(line))[20].kappa, -0.02, 1e-6);
}

TEST(LineEdit, CutsAndJoinsToWhatItWas) {
  const EditableLine line = editable(test::arc({}, 0.02, 50.0, 0.5));
  const EditableLine first = cut(line, 0.0, 20.25), second = cut(line, 20.25, length_of(line));
  EXPECT_NEAR(length_of(first), 20.25, 1e-3);
  EXPECT_NEAR((first.points.back() - second.points.front()).norm(), 0.0, 1e-9);
  const EditableLine joined = join({first, second}, 0.1);
  EXPECT_NEAR(length_of(joined), length_of(line), 1e-3);
  EXPECT_EQ(joined.points.size(), line.points.size() + 1);
  // An overlap is taken once.
  EXPECT_NEAR(length_of(join({cut(line, 0.0, 30.0), cut(line, 20.0, 49.0)}, 1.0)), 49.0, 0.05);
}

TEST(LineEdit, CutsALoopAcrossItsStart) {
  const EditableLine loop = lap(20.0, 400);
  const EditableLine part = cut(loop, 100.0, 20.0);
  EXPECT_FALSE(part.closed());
  EXPECT_NEAR(length_of(part), length_of(loop) - 80.0, 0.01);
}

TEST(LineEdit, WhatCannotBeCutOrJoinedIsSaid) {
  const EditableLine line = editable(test::straight({}, 50.0, 0.5));
  EXPECT_THAT(fault_of([&] { cut(line, 30.0, 20.0); }), HasSubstr("ends before it starts"));
  EXPECT_THAT(fault_of([&] { cut(line, 0.0, 80.0); }), HasSubstr("from s = 0 to 50.00 m"));
  EXPECT_THAT(fault_of([&] {
                join({line, editable(test::straight(Pose2({90.0, 0.0}, 0.0), 9.0, 0.5))}, 5.0);
              }),
              HasSubstr("line 1 starts 40.00 m from the end"));
  EXPECT_NE(fault_of([&] { join({line, reverse(line)}, 5.0); }), "");
  EXPECT_THAT(fault_of([&] {
                join({line, editable(test::straight(Pose2({50.1, 0.0}, 1.5), 9.0, 0.5))}, 5.0);
              }),
              HasSubstr("another direction"));
}

TEST(LineEdit, CoordinatesThatAreNotFiniteAndSinglePointsAreRefused) {
  EXPECT_THAT(fault_of([] { editable({{0.0, 0.0}, {test::kNaN, 1.0}}); }), HasSubstr("point 1"));
  EXPECT_THAT(fault_of([] {
                editable({{1.0, 1.0}, {1.0, 1.0}});
              }),
              HasSubstr("fewer than two distinct points"));
}

}  // namespace
}  // namespace relative_map::core
