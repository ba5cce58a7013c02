#include "relative_map/geometry/segment_index.hpp"

#include <gtest/gtest.h>

#include <random>

#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::path_through;

/// Every place of a closed or open path, by looking at each segment.
std::vector<Foot> feet_by_brute_force(const PathPoints& path, Ends ends, const Point2& point) {
  std::vector<Foot> feet;
  const std::size_t segments = ends == Ends::kClosed ? path.size() : path.size() - 1;
  for (std::size_t i = 0; i < segments; ++i) {
    Foot foot = project_on_segment(path[i].position, path[(i + 1) % path.size()].position, point);
    foot.segment = i;
    feet.push_back(foot);
  }
  return feet;
}

/// A random walk that turns gently, a few metres a step: it crosses itself now and then.
PathPoints random_path(std::mt19937& random, std::size_t count) {
  std::uniform_real_distribution<double> turn(-0.4, 0.5), step(0.5, 3.0);
  Polyline points{Point2::Zero()};
  double heading = 0.0;
  while (points.size() < count) {
    heading += turn(random);
    points.push_back(points.back() + step(random) * Point2(std::cos(heading), std::sin(heading)));
  }
  return path_through(points);
}

TEST(SegmentIndex, FindsTheNearestSegmentAsBruteForceDoes) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> coordinate(-60.0, 60.0);
  for (const Ends ends : {Ends::kOpen, Ends::kClosed}) {
    for (const std::size_t count : {2u, 3u, 16u, 17u, 33u, 500u}) {
      const PathPoints path = random_path(random, count);
      const SegmentIndex index(path, ends);
      for (int i = 0; i < 200; ++i) {
        const Point2 point(coordinate(random), coordinate(random));
        const std::vector<Foot> feet = feet_by_brute_force(path, ends, point);
        double least = feet.front().squared_distance;
        for (const Foot& foot : feet) least = std::min(least, foot.squared_distance);
        EXPECT_EQ(index.nearest(path, point).squared_distance, least);
      }
    }
  }
}

TEST(SegmentIndex, FindsEveryPassAsBruteForceDoes) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> coordinate(-60.0, 60.0);
  for (const Ends ends : {Ends::kOpen, Ends::kClosed}) {
    const PathPoints path = random_path(random, 300);
    const SegmentIndex index(path, ends);
    const auto along = [&](std::size_t segment) -> Point2 {
      return path[(segment + 1) % path.size()].position - path[segment].position;
    };
    for (int i = 0; i < 300; ++i) {
      const Point2 point(coordinate(random), coordinate(random));
      const std::vector<Foot> feet = feet_by_brute_force(path, ends, point);
      std::vector<std::size_t> expected;
      for (std::size_t k = 0; k < feet.size(); ++k) {
        const bool wraps = ends == Ends::kClosed;
        const bool first = k == 0 && !wraps, last = k + 1 == feet.size() && !wraps;
        const double here = feet[k].squared_distance;
        const double before = feet[(k + feet.size() - 1) % feet.size()].squared_distance;
        const double after = feet[(k + 1) % feet.size()].squared_distance;
        const auto turns_back = [&](std::size_t a, std::size_t b) {  // and neither foot is its tip
          return feet[a].fraction < 1.0 && feet[b].fraction > 0.0 && along(a).dot(along(b)) < 0.0;
        };
        const std::size_t next = (k + 1) % feet.size(), previous = (k + feet.size() - 1) % feet.size();
        if (here <= 225.0 && (first || here < before || turns_back(previous, k)) &&
            (last || here <= after || turns_back(k, next))) {
          expected.push_back(k);
        }
      }
      std::vector<std::size_t> found;
      for (const Foot& foot : index.passes(path, point, 15.0)) found.push_back(foot.segment);
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(SegmentIndex, CountsAVertexThatTwoSegmentsShareOnce) {
  const PathPoints path = path_through({Point2(0.0, 0.0), Point2(10.0, 0.0), Point2(10.0, 10.0)});
  const SegmentIndex index(path, Ends::kOpen);
  EXPECT_EQ(index.passes(path, Point2(12.0, -2.0), 15.0).size(), 1u);
}

TEST(SegmentIndex, FindsBothPassesOfAFigureEight) {
  Polyline points;
  for (int i = 0; i < 400; ++i) {
    const double t = 2.0 * kPi * i / 400.0;
    points.push_back(Point2(60.0 * std::sin(t), 30.0 * std::sin(2.0 * t)));
  }
  const PathPoints path = path_through(points);
  const SegmentIndex index(path, Ends::kClosed);
  const std::vector<Foot> at_crossing = index.passes(path, Point2(0.3, 0.2), 5.0);
  ASSERT_EQ(at_crossing.size(), 2u);
  EXPECT_LT(at_crossing[0].segment, at_crossing[1].segment);
  EXPECT_EQ(index.passes(path, Point2(60.0, 0.0), 5.0).size(), 1u) << "at the turn there is but one";
  EXPECT_TRUE(index.passes(path, Point2(500.0, 0.0), 5.0).empty());
}

TEST(SegmentIndex, ClosesALapWithASegmentFromItsLastPointToItsFirst) {
  const PathPoints path = path_through(test::circle(30.0, 40));
  const Point2 beside_seam = 29.0 * Point2(std::cos(-0.05), std::sin(-0.05));
  const SegmentIndex closed(path, Ends::kClosed), open(path, Ends::kOpen);
  ASSERT_EQ(closed.passes(path, beside_seam, 5.0).size(), 1u);
  EXPECT_EQ(closed.passes(path, beside_seam, 5.0)[0].segment, 39u);
  EXPECT_EQ(closed.nearest(path, beside_seam).segment, 39u);
  EXPECT_EQ(open.passes(path, beside_seam, 5.0).size(), 2u) << "an open line has an end on either side";
}

TEST(SegmentIndex, CountsOnePassAcrossTheSeamOfALap) {
  const PathPoints path = path_through(test::circle(30.0, 40));
  const SegmentIndex index(path, Ends::kClosed);
  const std::vector<Foot> passes = index.passes(path, Point2(31.0, 0.0), 5.0);
  ASSERT_EQ(passes.size(), 1u) << "the seam's vertex is shared by the last segment and the first";
  EXPECT_NEAR(passes[0].squared_distance, 1.0, 1e-12);
}

TEST(SegmentIndex, PassesOfAPathThatTurnsBackAreTwo) {
  const PathPoints path = test::path_through({{0, 0}, {10, 0}, {0, 0.2}});
  const std::vector<Foot> passes = SegmentIndex(path, Ends::kOpen).passes(path, {9.0, -0.1}, 5.0);
  ASSERT_EQ(passes.size(), 2u);
  EXPECT_EQ(passes[0].segment, 0u);
  EXPECT_EQ(passes[1].segment, 1u);
}

}  // namespace
}  // namespace relative_map::core
