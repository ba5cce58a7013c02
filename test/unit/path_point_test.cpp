#include "relative_map/geometry/path_point.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "relative_map/simulation/road.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::circle;
using test::path_through;
using test::straight;

/// Places along a line, at most unevenly spaced: steps of 0.1 m beside steps of 3 m.
std::vector<double> uneven_places(double length) {
  std::vector<double> places;
  double s = 0.0;
  for (std::size_t i = 0; s <= length; ++i) {
    places.push_back(s);
    s += i % 3 == 0 ? 0.1 : (i % 3 == 1 ? 3.0 : 1.1);
  }
  return places;
}

TEST(Geometry, OfAStraightLineIsStraight) {
  const Pose2 start(Point2(5.0, -7.0), 2.5);
  Polyline points;
  for (const double s : uneven_places(50.0)) points.push_back(start.to_parent(Point2(s, 0.0)));
  const PathPoints path = path_through(points);
  const std::vector<double> places = uneven_places(50.0);
  for (std::size_t i = 0; i < path.size(); ++i) {
    EXPECT_NEAR(path[i].s, places[i], 1e-12);
    EXPECT_NEAR(path[i].theta, 2.5, 1e-12);
    EXPECT_NEAR((path[i].direction - start.forward()).norm(), 0.0, 1e-12);
    EXPECT_NEAR(path[i].kappa, 0.0, 1e-12);
    EXPECT_NEAR(path[i].dkappa, 0.0, 1e-11);
  }
}

TEST(Geometry, OfACircleIsExactHoweverUnevenlySampled) {
  for (const double radius : {20.0, -35.0}) {
    const Pose2 start(Point2(1.0, 2.0), 3.0);
    Polyline points;
    const std::vector<double> places = uneven_places(60.0);
    for (const double s : places) points.push_back(test::along_arc(start, 1.0 / radius, s).position());
    const PathPoints path = path_through(points);
    for (std::size_t i = 0; i < path.size(); ++i) {
      EXPECT_NEAR(angle_difference(path[i].theta, 3.0 + places[i] / radius), 0.0, 1e-11) << "point " << i;
      EXPECT_NEAR(path[i].direction.norm(), 1.0, 1e-15);
      EXPECT_NEAR(path[i].kappa, 1.0 / radius, 1e-10);
      EXPECT_NEAR(path[i].dkappa, 0.0, 1e-9);
    }
  }
}

TEST(Geometry, OfAClothoidIsThatOfTheCurve) {
  const RoadShape road = RoadShape().add_clothoid(100.0, -0.01, 0.02);
  Polyline points;
  for (int i = 0; i <= 200; ++i) points.push_back(road.at(0.5 * i).position);
  const PathPoints path = path_through(points);
  for (std::size_t i = 1; i + 1 < path.size(); ++i) {
    const PathPoint truth = road.at(0.5 * static_cast<double>(i));
    // A circle through three points h apart misses the tangent of a clothoid by dkappa h^2 / 6.
    EXPECT_NEAR(angle_difference(path[i].theta, truth.theta), 3e-4 * 0.25 / 6.0, 1e-7);
    EXPECT_NEAR(path[i].kappa, truth.kappa, 1e-6);
    if (i > 1 && i + 2 < path.size()) {
      EXPECT_NEAR(path[i].dkappa, truth.dkappa, 1e-6);
    }
  }
  EXPECT_NEAR(path.front().theta, 0.0, 1e-4) << "at the ends from the first circle";
  EXPECT_NEAR(path.front().kappa, -0.01, 2e-4);
}

TEST(Geometry, OfALapGoesRoundTheSeam) {
  PathPoints path(100);
  const Polyline points = circle(30.0, 100);
  for (std::size_t i = 0; i < path.size(); ++i) path[i].position = points[i];
  compute_arc_length(path);
  const double chord = 2.0 * 30.0 * std::sin(kPi / 100.0);
  compute_geometry(path, Ends::kClosed, 100.0 * chord);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double angle = 2.0 * kPi * static_cast<double>(i) / 100.0;
    EXPECT_NEAR(angle_difference(path[i].theta, angle + kPi / 2.0), 0.0, 1e-12);
    EXPECT_NEAR(path[i].kappa, 1.0 / 30.0, 1e-12);
    EXPECT_NEAR(path[i].dkappa, 0.0, 1e-11);
    EXPECT_NEAR(path[i].s, static_cast<double>(i) * chord, 1e-10);
  }
}

TEST(Geometry, OfALapHasTheRatesOfCurvatureAcrossTheSeam) {
  // An ellipse that starts where its curvature changes.
  PathPoints path(400);
  const auto angle_of = [](std::size_t i) { return kPi / 4.0 + 2.0 * kPi * static_cast<double>(i) / 400.0; };
  for (std::size_t i = 0; i < path.size(); ++i) {
    path[i].position = Point2(40.0 * std::cos(angle_of(i)), 25.0 * std::sin(angle_of(i)));
  }
  compute_arc_length(path);
  const double lap = path.back().s + (path.front().position - path.back().position).norm();
  compute_geometry(path, Ends::kClosed, lap);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const double s = std::sin(angle_of(i)), c = std::cos(angle_of(i));
    const double speed = std::hypot(40.0 * s, 25.0 * c);
    const double kappa = 1000.0 / (speed * speed * speed);
    const double dkappa = -3.0 * kappa / speed * (1600.0 - 625.0) * s * c / (speed * speed);
    EXPECT_NEAR(path[i].kappa, kappa, 1e-5) << "point " << i;
    EXPECT_NEAR(path[i].dkappa, dkappa, 5e-6) << "point " << i;
  }
}

TEST(Geometry, OfTwoPointsIsTheirChord) {
  const PathPoints path = path_through({Point2(1.0, 1.0), Point2(4.0, 5.0)});
  for (const PathPoint& point : path) {
    EXPECT_NEAR(point.theta, std::atan2(4.0, 3.0), 1e-15);
    EXPECT_EQ(point.kappa, 0.0);
    EXPECT_EQ(point.dkappa, 0.0);
  }
  EXPECT_EQ(path.back().s, 5.0);
}

TEST(Geometry, OfAnAboutTurnOnTheSpotIsFinite) {
  const PathPoints path = path_through({Point2(0.0, 0.0), Point2(1.0, 0.0), Point2(0.0, 0.0)});
  for (const PathPoint& point : path) {
    EXPECT_TRUE(std::isfinite(point.theta));
    EXPECT_TRUE(std::isfinite(point.kappa));
    EXPECT_TRUE(std::isfinite(point.dkappa));
    EXPECT_NEAR(point.direction.norm(), 1.0, 1e-15);
  }
}

TEST(Interpolation, IsHeldAtTheEnds) {
  const PathPoints path = path_through(straight(Pose2(), 10.0, 1.0));
  std::size_t hint = 3;
  EXPECT_EQ(interpolate(path, -5.0, hint).position, path.front().position);
  EXPECT_EQ(hint, 0u);
  EXPECT_EQ(interpolate(path, 99.0, hint).position, path.back().position);
  EXPECT_EQ(hint, 10u);
}

TEST(Interpolation, FindsItsVertexFromAnyHint) {
  const PathPoints path = path_through(arc(Pose2(Point2(0.0, 0.0), kPi - 0.1), 0.02, 20.0, 0.5));
  for (const std::size_t from : {0u, 7u, 20u, 40u}) {
    std::size_t hint = from;
    const PathPoint point = interpolate(path, 7.3, hint);
    EXPECT_EQ(point.s, 7.3);
    EXPECT_LE(path[hint].s, 7.3);
    EXPECT_GT(path[hint + 1].s, 7.3);
    const Pose2 truth = test::along_arc(Pose2(Point2(0.0, 0.0), kPi - 0.1), 0.02, 7.3);
    EXPECT_NEAR((point.position - truth.position()).norm(), 0.0, 1e-3);
    EXPECT_NEAR(angle_difference(point.theta, truth.heading()), 0.0, 1e-4) << "across pi";
    EXPECT_NEAR(point.direction.norm(), 1.0, 1e-15);
    EXPECT_NEAR(point.kappa, 0.02, 1e-9);
  }
}

TEST(Interpolation, AtAVertexIsTheVertex) {
  const PathPoints path = path_through(straight(Pose2(Point2(1.0, 1.0), 0.4), 10.0, 1.0));
  std::size_t hint = 0;
  for (const PathPoint& vertex : path) {
    const PathPoint point = interpolate(path, vertex.s, hint);
    EXPECT_EQ(point.position, vertex.position);
    EXPECT_EQ(point.s, vertex.s);
  }
}

TEST(SmoothInterpolation, StaysOnTheCurveBetweenItsVertices) {
  const PathPoints path = path_through(arc(Pose2(), 0.05, 40.0, 1.0));
  std::size_t hint = 0;
  for (double s = 0.0; s < path.back().s; s += 0.13) {
    const PathPoint point = interpolate_smoothly(path, s, hint);
    EXPECT_NEAR((point.position - Point2(0.0, 20.0)).norm(), 20.0, 1e-6) << "where the chord is 6 mm inside";
    EXPECT_EQ(point.s, s);
  }
  EXPECT_EQ(interpolate_smoothly(path, -1.0, hint).position, path.front().position);
  EXPECT_EQ(interpolate_smoothly(path, path.back().s, hint).position, path.back().position);
  EXPECT_EQ(interpolate_smoothly(path, path[7].s, hint).position, path[7].position);
}

TEST(Projection, OnASegmentIsHeldAtItsEnds) {
  const Point2 a(1.0, 1.0), b(5.0, 1.0);
  const Foot beside = project_on_segment(a, b, Point2(2.0, 4.0));
  EXPECT_EQ(beside.fraction, 0.25);
  EXPECT_EQ(beside.point, Point2(2.0, 1.0));
  EXPECT_EQ(beside.squared_distance, 9.0);
  EXPECT_EQ(project_on_segment(a, b, Point2(-2.0, 5.0)).squared_distance, 25.0);
  EXPECT_EQ(project_on_segment(a, b, Point2(9.0, 1.0)).fraction, 1.0);
  EXPECT_EQ(project_on_segment(a, a, Point2(1.0, 3.0)).squared_distance, 4.0) << "a segment without length";
}

TEST(PolylineWalker, FindsTheNearestPlaceBesideEachPointOfAParallel) {
  const Polyline polyline = arc(Pose2(), 0.02, 60.0, 0.7);
  PolylineWalker walker(polyline);
  for (const Point2& point : arc(Pose2(Point2(0.0, 3.5), 0.0), 1.0 / (50.0 - 3.5), 55.0, 0.4)) {
    const Foot foot = walker.next(point);
    const Foot truth = test::nearest_by_brute_force(polyline, point);
    EXPECT_NEAR(foot.squared_distance, truth.squared_distance, 1e-12);
  }
}

TEST(PolylineWalker, FindsTheNearestOfSeveralSegmentsThatAPointLiesBeside) {
  // On the inside of a sharp, coarsely sampled curve the normals of its segments cross.
  const Polyline polyline = arc(Pose2(), 0.1, 15.0, 2.5);
  Polyline inside = arc(Pose2(Point2(0.0, 6.0), 0.0), 0.25, 6.0, 0.1);
  for (const bool backwards : {false, true}) {
    if (backwards) std::reverse(inside.begin(), inside.end());
    PolylineWalker walker(polyline);
    for (const Point2& point : inside) {
      EXPECT_NEAR(std::sqrt(walker.next(point).squared_distance),
                  test::distance_by_brute_force(polyline, point), 1e-12);
    }
  }
}

TEST(PolylineWalker, OnThePolylineTheDistanceIsANumber) {
  // By Pythagoras the square of nothing may come out as less than nothing.
  const Polyline polyline = straight(Pose2(Point2(-0.984, -4.507), 0.0458), 50.0, 0.4707);
  PolylineWalker walker(polyline);
  const Point2 start = polyline.front(), step = (polyline.back() - polyline.front()) / 1000.0;
  for (int i = 0; i <= 1000; ++i) {
    const Foot foot = walker.next(start + i * step);
    EXPECT_GE(foot.squared_distance, 0.0);
    EXPECT_LT(foot.squared_distance, 1e-12);
  }
}

TEST(PolylineWalker, GoesByAGuessOfHowFarItIs) {
  const Polyline polyline = arc(Pose2(), 0.02, 100.0, 0.5);
  const Polyline beside = arc(Pose2(Point2(0.0, -2.0), 0.0), 1.0 / 52.0, 100.0, 0.5);
  for (const std::size_t steps : {2u, 10u, 30u}) {
    for (const std::size_t guess : {1u, 5u, 60u}) {
      PolylineWalker walker(polyline);
      for (std::size_t i = 0; i < beside.size(); i += steps) {
        EXPECT_NEAR(std::sqrt(walker.next(beside[i], guess).squared_distance),
                    test::distance_by_brute_force(polyline, beside[i]), 1e-9);
      }
    }
  }
}

TEST(PolylineWalker, IsNotHeldUpByAKink) {
  Polyline polyline = straight(Pose2(), 50.0, 0.25);
  polyline[80] += Point2(-0.3, 0.2);  // so noisy that it steps back
  PolylineWalker walker(polyline);
  for (double x = 1.0; x < 49.0; x += 0.4) {
    EXPECT_NEAR(std::sqrt(walker.next(Point2(x, 1.75)).squared_distance),
                test::distance_by_brute_force(polyline, Point2(x, 1.75)), 1e-9);
  }
}

TEST(PolylineWalker, WalksBackToo) {
  const Polyline polyline = straight(Pose2(), 100.0, 1.0);
  PolylineWalker walker(polyline);
  EXPECT_EQ(walker.next(Point2(90.5, 1.0)).segment, 90u);
  EXPECT_EQ(walker.next(Point2(10.5, 1.0)).segment, 10u);
}

TEST(PolylineWalker, KnowsWhatLiesBeyondTheEnds) {
  const Polyline polyline = straight(Pose2(), 10.0, 1.0);
  PolylineWalker walker(polyline);
  EXPECT_TRUE(walker.beyond_end(walker.next(Point2(-1.0, 2.0))));
  EXPECT_FALSE(walker.beyond_end(walker.next(Point2(0.5, 2.0))));
  EXPECT_FALSE(walker.beyond_end(walker.next(Point2(5.0, 2.0)))) << "at a vertex within";
  EXPECT_TRUE(walker.beyond_end(walker.next(Point2(11.0, 2.0))));
}

TEST(PolylineWalker, StopsAtAVertexThatPointsOut) {
  // Outside of a corner both segments send the point to the other one.
  const Polyline corner = {Point2(0.0, 0.0), Point2(10.0, 0.0), Point2(10.0, 10.0)};
  PolylineWalker walker(corner);
  const Foot foot = walker.next(Point2(12.0, -2.0));
  EXPECT_EQ(foot.point, Point2(10.0, 0.0));
  EXPECT_NEAR(foot.squared_distance, 8.0, 1e-12);
}

TEST(ChordLength, IsTheSumOfTheChords) {
  EXPECT_EQ(chord_length({}), 0.0);
  EXPECT_EQ(chord_length({Point2(1.0, 1.0)}), 0.0);
  EXPECT_EQ(chord_length({Point2(0.0, 0.0), Point2(3.0, 4.0), Point2(3.0, 5.0)}), 6.0);
}

TEST(Kinks, AreTurnsOfMoreThanARightAngle) {
  EXPECT_EQ(find_kinks(test::path_through({{0, 0}, {2, 0}, {2, 2}, {2.5, 1}, {3, 3}, {5, 3}})),
            std::vector<std::size_t>({2, 3}));
  const PathPoints triangle = test::path_through({{0, 0}, {4, 0}, {2, 3}});
  EXPECT_EQ(find_kinks(triangle), std::vector<std::size_t>({1}));
  EXPECT_EQ(find_kinks(triangle, Ends::kClosed), std::vector<std::size_t>({0, 1, 2})) << "at the seam, too";
}

TEST(WidestGap, IsThatOfPointsBesideTheOtherLine) {
  const Polyline line = {{-5, 9}, {0, 0}, {1, 0.5}, {2, -0.7}, {3, 0}, {9, 9}};
  const Gap gap = widest_gap(line, {{0, 0}, {3, 0}});
  EXPECT_NEAR(gap.width, 0.7, 1e-12);
  EXPECT_EQ(gap.place, Point2(2, -0.7));
  EXPECT_EQ(widest_gap({{-5, 9}, {9, 9}}, {{0, 0}, {3, 0}}).width, 0.0) << "neither is beside it";
}

}  // namespace
}  // namespace relative_map::core
