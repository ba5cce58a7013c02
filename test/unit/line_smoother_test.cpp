#include "relative_map/tools/line_smoother.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/simulation/noise.hpp"
#include "relative_map/simulation/road.hpp"
#include "relative_map/tools/line_check.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using testing::HasSubstr;

RecordedLine noisy(RecordedLine line, double standard_deviation) {
  NoiseSource noise(17, 1);
  for (LinePoint& point : line.points) {
    point.x += noise.draw(standard_deviation);
    point.y += noise.draw(standard_deviation);
    point.theta = point.kappa = point.dkappa = point.s = test::kNaN;
  }
  return line;
}

SmoothedLine smooth(const RecordedLine& line, const SmootherParam& param = {}) {
  return smooth_line(make_editable(line), param, [](double) {});
}

/// The integral of dkappa^2.
double roughness(const RecordedLine& line) {
  double sum = 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    sum += line.points[i].dkappa * line.points[i].dkappa * (line.points[i].s - line.points[i - 1].s);
  }
  return sum;
}

double farthest(const RecordedLine& from, const RecordedLine& to) {
  Polyline track;
  for (const LinePoint& point : to.points) track.emplace_back(point.x, point.y);
  double worst = 0.0;
  for (const LinePoint& point : from.points) {
    worst = std::max(worst, test::distance_by_brute_force(track, {point.x, point.y}));
  }
  return worst;
}

RecordedLine corner() {
  return RoadShape(Pose2({690000.0, 3118000.0}, 0.3))
      .add_straight(60.0)
      .add_arc(2.5 * kPi, 0.2)
      .add_straight(60.0)
      .lane(0.0, 0.5);
}

TEST(Smoother, LeavesAStraightLineAndACircleWhereTheyAre) {
  for (const Polyline& points : {test::straight(Pose2({5.0, -3.0}, 2.0), 100.0, 0.5),
                                 test::arc(Pose2({5.0, -3.0}, 2.0), 0.02, 100.0, 0.5)}) {
    const SmoothedLine result = smooth(test::recording(points));
    EXPECT_EQ(result.fault, "");
    EXPECT_LT(result.greatest_deviation, 0.002);  // the cubics' and the chords' own
    EXPECT_LT(result.greatest_dkappa, 1e-4);
  }
}

TEST(Smoother, HoldsTheBoundAndKeepsTheEnds) {
  const RecordedLine recorded = noisy(demo_road(Pose2({690000.0, 3118000.0}, 0.7)).lane(0.0, 0.5), 0.07);
  const SmoothedLine result = smooth(recorded);
  ASSERT_EQ(result.fault, "");
  const RecordedLine line = make_recorded(result.line);
  EXPECT_LE(farthest(recorded, line), 0.2502);
  EXPECT_LE(farthest(line, recorded), 0.2502);
  EXPECT_NEAR(result.greatest_deviation, farthest(recorded, line), 0.02);
  EXPECT_NEAR(line.points.front().x, recorded.points.front().x, 1e-9);
  EXPECT_NEAR(line.points.front().y, recorded.points.front().y, 1e-9);
  EXPECT_NEAR(line.points.back().x, recorded.points.back().x, 1e-9);
  EXPECT_NEAR(line.points.back().y, recorded.points.back().y, 1e-9);
  EXPECT_LT(result.greatest_kappa, 0.03);    // the road's is 1/60
  EXPECT_LT(result.greatest_dkappa, 0.005);  // the recording's is about 1
}

TEST(Smoother, AWiderBoundIsNeverRougher) {
  const RecordedLine recorded = noisy(demo_road().lane(0.0, 0.5), 0.05);
  double before = roughness(make_recorded(make_editable(recorded)));
  for (double bound : {0.25, 0.5, 1.0}) {
    SmootherParam param;
    param.bound = bound;
    const double now = roughness(make_recorded(smooth(recorded, param).line));
    EXPECT_LT(now, before) << bound;
    before = now;
  }
}

TEST(Smoother, ACornerOfFiveMetresSurvives) {
  for (double noise : {0.0, 0.05}) {
    const SmoothedLine result = smooth(noisy(corner(), noise));
    EXPECT_EQ(result.fault, "");
    EXPECT_LE(farthest(make_recorded(result.line), corner()), 0.26 + noise);
    EXPECT_GT(result.greatest_kappa, 0.15);
    EXPECT_LT(result.greatest_kappa, 0.22);
  }
}

TEST(Smoother, ALoopStaysOneAndIsSmoothAcrossItsSeam) {
  RecordedLine lap = noisy(closed_road(Pose2({690000.0, 3118000.0}, 0.3)).lane(0.0, 0.5), 0.05);
  lap.points.back() = lap.points.front();
  const SmoothedLine result = smooth(lap);
  ASSERT_EQ(result.fault, "");
  EXPECT_TRUE(result.line.closed());
  EXPECT_LT(result.greatest_dkappa, 0.002);  // the seam is counted
  const RecordedLine line = make_recorded(result.line);
  EXPECT_EQ(line.points.front().x, line.points.back().x);
  EXPECT_EQ(line.points.front().kappa, line.points.back().kappa);
  const auto prepared = prepare_navigation_lines({"map", {line}}, {});
  EXPECT_TRUE(prepared->lines.at(0).closed());
}

TEST(Smoother, GeometryIsTheResultsOwnAndIsKeptOnIntake) {
  const RecordedLine line = make_recorded(smooth(noisy(demo_road().lane(0.0, 0.5), 0.05)).line);
  const auto prepared = prepare_navigation_lines({"map", {line}}, {});
  ASSERT_EQ(prepared->lines.size(), 1u);
  const PathPoints& points = prepared->lines[0].points;
  ASSERT_EQ(points.size(), line.points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(points[i].theta, line.points[i].theta) << i;
    EXPECT_EQ(points[i].kappa, line.points[i].kappa) << i;
    EXPECT_EQ(points[i].dkappa, line.points[i].dkappa) << i;
    EXPECT_NEAR(points[i].s, line.points[i].s, 1e-6) << i;
  }
}

TEST(Smoother, NoiseThatIsTooMuchForTheBoundIsNamedWithItsPlaceAndWhatWouldDo) {
  for (double noise_level : {0.15, 0.3, 0.5, 1.0}) {
    SCOPED_TRACE(noise_level);
    const RecordedLine recorded = noisy(demo_road().lane(0.0, noise_level < 0.4 ? 0.5 : 1.5), noise_level);
    EXPECT_THAT(smooth(recorded).fault, HasSubstr("the bound of 0.25 m cannot be held at s = "));
    const auto param = find_feasible(make_editable(recorded), {}, 10.0, [](double) {});
    ASSERT_TRUE(param);
    EXPECT_GT(param->bound, 2.5 * noise_level);
    EXPECT_LT(param->bound, 6.0 * noise_level);
    const SmoothedLine better = smooth(recorded, *param);
    EXPECT_EQ(better.fault, "");
    EXPECT_LT(better.greatest_dkappa, 0.005 * noise_level + 5e-4);
    EXPECT_TRUE(check_line(make_recorded(better.line), {}, {}).empty());  // fit to be driven on
  }
}

TEST(Smoother, ARecordingThatNoVehicleCanFollowIsRefused) {
  RecordedLine step = test::recording(test::straight({}, 100.0, 0.5));
  for (std::size_t i = 100; i < step.points.size(); ++i) step.points[i].y += 2.0;
  EXPECT_THAT(smooth(step).fault, HasSubstr("cannot be held at s = "));
  const auto param = find_feasible(make_editable(step), {}, 10.0, [](double) {});
  ASSERT_TRUE(param);
  EXPECT_EQ(smooth(step, *param).fault, "");
  EXPECT_LT(param->bound, 1.5);
  EXPECT_FALSE(find_feasible(make_editable(step), {}, 0.3, [](double) {}));
}

TEST(Smoother, SparsePointsAndHeightsGoAlong) {
  RecordedLine recorded = demo_road().lane(0.0, 3.0);
  for (LinePoint& point : recorded.points) point.z = 10.0 + 0.01 * point.s;
  const SmoothedLine result = smooth(recorded);
  EXPECT_EQ(result.fault, "");
  const RecordedLine line = make_recorded(result.line);
  EXPECT_NEAR(line.points[1].s, 0.5, 0.01);
  for (const LinePoint& point : line.points) EXPECT_NEAR(point.z, 10.0 + 0.01 * point.s, 0.02);
}

TEST(Smoother, TellsTheLongestGapOfTheRecording) {
  RecordedLine recorded = demo_road().lane(0.0, 0.5);
  EXPECT_NEAR(smooth(recorded).longest_gap, 0.5, 0.01);
  recorded.points.erase(recorded.points.begin() + 201, recorded.points.begin() + 241);
  const SmoothedLine result = smooth(recorded);
  EXPECT_NEAR(result.longest_gap, 20.5, 0.1);
  EXPECT_NEAR(result.gap_s, 100.0, 0.6);
}

TEST(Smoother, TheShortestLineIsSmoothedToo) {
  EXPECT_EQ(smooth(test::recording({{0.0, 0.0}, {1.0, 0.1}})).fault, "");
}

}  // namespace
}  // namespace relative_map::core
