#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/geometry/self_crossings.hpp"
#include "relative_map/simulation/noise.hpp"
#include "relative_map/simulation/road.hpp"
#include "relative_map/tools/line_edit.hpp"
#include "support/editable_lines.hpp"
#include "support/lines.hpp"
#include "support/temporary_folder.hpp"

namespace relative_map::core {
namespace {

using test::editable;
using test::fault_of;
using test::lap;
using testing::HasSubstr;

TEST(LineOffset, TheParallelOfACircleIsACircle) {
  for (double distance : {3.5, -3.5}) {
    const EditableLine line = offset(lap(20.0, 400), distance);  // counter-clockwise: left is inward
    EXPECT_TRUE(line.closed());
    for (const Point2& point : line.points) {
      EXPECT_NEAR((point + line.origin).norm(), 20.0 - distance, 1e-6);
    }
    for (const PathPoint& point : path_of(line)) EXPECT_NEAR(point.kappa, 1.0 / (20.0 - distance), 1e-6);
  }
}

TEST(LineOffset, AParallelThatWouldFoldIsRefusedWithItsPlace) {
  const EditableLine line = editable(test::arc({}, 0.3, 9.0, 0.25));
  EXPECT_THAT(fault_of([&] { offset(line, 3.5); }), HasSubstr("the curve's radius is 3.33 m"));
  EXPECT_EQ(fault_of([&] { offset(line, -3.5); }), "");
}

/// Out, round a bulb of 10 m radius to the left, and back in through a neck that is `width` [m] wide.
Polyline keyhole(double width) {
  const double turn = std::acos(0.5 * (10.0 + 0.5 * width) / 10.0);  // of the arcs that lead into the bulb
  RoadShape road(Pose2({0.0, -0.5 * width}, 0.0));
  road.add_straight(40.0)
      .add_arc(10.0 * turn, -0.1)
      .add_arc(10.0 * (kPi + 2.0 * turn), 0.1)
      .add_arc(10.0 * turn, -0.1)
      .add_straight(40.0);
  Polyline points;
  for (const LinePoint& point : road.lane(0.0, 0.5).points) points.emplace_back(point.x, point.y);
  return points;
}

TEST(LineOffset, AParallelThatWouldCrossItselfIsRefusedWithItsPlace) {
  const EditableLine narrow = editable(keyhole(5.0));
  const double length = length_of(narrow);
  EXPECT_EQ(self_crossings(narrow.points, Ends::kOpen).size(), 0u);
  const std::string fault = fault_of([&] { offset(narrow, 3.5); });
  double first = 0.0, second = 0.0;
  ASSERT_EQ(
      std::sscanf(fault.c_str(),
                  "at s = %lf m the parallel at 3.50 m crosses itself, since the line comes back too near "
                  "to it at s = %lf",
                  &first, &second),
      2)
      << fault;
  EXPECT_NEAR(first, 45.0, 5.0);
  EXPECT_NEAR(first + second, length, 1.0);
  EXPECT_EQ(fault_of([&] { offset(narrow, -3.5); }), "");
  EXPECT_EQ(fault_of([&] { offset(narrow, 2.3); }), "");
  EXPECT_EQ(fault_of([&] { offset(editable(keyhole(7.6)), 3.5); }), "");
}

TEST(LineOffset, ALineThatCrossesItselfHasAParallelThatDoes) {
  for (double turn : {1.0, 1.5, 2.2}) {  // [rad] at which the ends cross
    RoadShape road(Pose2({690000.0, 3118000.0}, 0.3));
    road.add_straight(100.0).add_arc(40.0 * (2.0 * kPi - turn), 0.025).add_straight(100.0);
    const EditableLine line = make_editable(road.lane(0.0, 0.5));
    EXPECT_EQ(self_crossings(line.points, Ends::kOpen).size(), 1u);
    for (double distance : {3.5, -3.5, 7.0, -7.0}) {
      EXPECT_EQ(fault_of([&] { offset(line, distance); }), "") << turn << ", " << distance;
    }
  }
}

TEST(LineOffset, ALapThatOverlapsHasAParallel) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Polyline points = test::arc({}, 0.02, 200.0 * kPi, 2.0);
    NoiseSource noise(seed, 1);
    for (Point2& point : points) point += Point2(noise.draw(0.03), noise.draw(0.03));
    EXPECT_GT(self_crossings(points, Ends::kOpen).size(), 5u);
    for (double distance : {3.5, -3.5}) {
      EXPECT_EQ(fault_of([&] { offset(editable(points), distance); }), "") << seed;
    }
  }
}

TEST(SelfCrossings, AreFoundOnceEachAndAcrossTheSeam) {
  EXPECT_TRUE(self_crossings(test::circle(20.0, 100), Ends::kClosed).empty());
  EXPECT_TRUE(self_crossings(test::straight({}, 100.0, 0.5), Ends::kOpen).empty());
  const Polyline eight = {{0.0, 0.0}, {4.0, 4.0}, {4.0, 0.0}, {0.0, 4.0}};
  const std::vector<SelfCrossing> found = self_crossings(eight, Ends::kClosed);
  ASSERT_EQ(found.size(), 1u);
  EXPECT_EQ(found[0].first, 0u);
  EXPECT_EQ(found[0].second, 2u);
  const Polyline seam = {{0.0, 4.0},  {0.0, 0.0},  {4.0, 4.0}, {8.0, 0.0},
                         {4.0, -4.0}, {1.0, -1.0}, {1.0, 5.0}};
  EXPECT_EQ(self_crossings(seam, Ends::kOpen).size(), 1u);
  EXPECT_EQ(self_crossings(seam, Ends::kClosed).size(), 1u);
  const Polyline through = {{0.0, 0.0}, {2.0, 0.0}, {4.0, 0.0}, {4.0, 2.0},
                            {2.0, 2.0}, {2.0, 0.0}, {2.0, -2.0}};
  EXPECT_EQ(self_crossings(through, Ends::kOpen).size(), 1u);
  const Polyline back = {{0.0, 0.0}, {4.0, 0.0}, {4.0, 1.0}, {2.0, 0.0}, {0.0, 1.0}};  // touches
  EXPECT_TRUE(self_crossings(back, Ends::kOpen).empty());
}

}  // namespace
}  // namespace relative_map::core
