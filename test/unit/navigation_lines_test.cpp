#include "relative_map/pipeline/lines/navigation_lines.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <set>

#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using test::recording;
using test::straight;
using testing::HasSubstr;

const Point2 kUtm(691191.9668313662, 3118215.5540518095);

std::shared_ptr<const NavigationLines> prepare(std::vector<RecordedLine> lines) {
  return prepare_navigation_lines({"map", std::move(lines)}, IntakeParam());
}

/// The only fault of a message that leaves no line.
std::string fault_of(const RecordedLine& line) {
  const auto prepared = prepare({line});
  EXPECT_TRUE(prepared->lines.empty());
  EXPECT_EQ(prepared->faults.size(), 1u);
  return prepared->faults.empty() ? "" : prepared->faults.front();
}

TEST(NavigationLines, NoLinesAreNoFault) {
  const auto prepared = prepare({});
  EXPECT_TRUE(prepared->lines.empty());
  EXPECT_TRUE(prepared->faults.empty());
  EXPECT_EQ(prepared->frame_id, "map");
}

TEST(NavigationLines, WithoutTwoDistinctPointsAreLeftOutWithTheReason) {
  EXPECT_THAT(fault_of(recording({}, "a")), HasSubstr("'a' is left out: it has no points"));
  EXPECT_THAT(fault_of(recording({kUtm}, "b")), HasSubstr("'b' is left out: it has fewer than two distinct"));
  EXPECT_THAT(fault_of(recording({kUtm, kUtm, kUtm})), HasSubstr("fewer than two distinct points"));
}

TEST(NavigationLines, WithCoordinatesThatAreNotFiniteAreLeftOutWithThePoint) {
  for (const double bad : {kNaN, std::numeric_limits<double>::infinity()}) {
    RecordedLine line = recording(straight(Pose2(), 50.0, 1.0));
    line.points[7].y = bad;
    EXPECT_THAT(fault_of(line),
                HasSubstr(std::isnan(bad) ? "path_point[7].y is nan" : "path_point[7].y is inf"));
  }
}

TEST(NavigationLines, WithCoordinatesThatAreNotOnEarthAreLeftOut) {
  RecordedLine line = recording(straight(Pose2(), 50.0, 1.0));
  line.points[7].x = 1e30;
  EXPECT_THAT(fault_of(line), HasSubstr("path_point[7].x is 1e+30 m"));
}

TEST(NavigationLines, ThatTurnBackOnTheSpotSayWhere) {
  Polyline points = straight(Pose2(), 50.0, 1.0);
  const Polyline back = straight(Pose2(Point2(49.0, 0.0), kPi), 49.0, 1.0);
  points.insert(points.end(), back.begin(), back.end());
  const auto prepared = prepare({recording(points, "there and back")});
  ASSERT_EQ(prepared->lines.size(), 1u);
  EXPECT_EQ(prepared->lines[0].kinks, std::vector<std::size_t>({50}));
  ASSERT_EQ(prepared->faults.size(), 1u);
  EXPECT_THAT(prepared->faults[0], HasSubstr("line 'there and back' turns back at s = 50 m"));
}

TEST(NavigationLines, WithCornersOfARightAngleDoNotTurnBack) {
  const auto prepared = prepare({recording({{0.0, 0.0}, {60.0, 0.0}, {60.0, 60.0}, {0.0, 60.0}})});
  EXPECT_TRUE(prepared->lines.at(0).kinks.empty());
  EXPECT_TRUE(prepared->faults.empty());
}

TEST(NavigationLines, OneBadLineDoesNotTakeTheOthersWithIt) {
  const auto prepared = prepare({recording({}, "bad"), recording(straight(Pose2(), 50.0, 1.0), "good")});
  ASSERT_EQ(prepared->lines.size(), 1u);
  EXPECT_EQ(prepared->lines[0].id, "good");
  EXPECT_EQ(prepared->faults.size(), 1u);
}

TEST(NavigationLines, LoseDuplicatePoints) {
  Polyline points = straight(Pose2(kUtm, 1.0), 20.0, 1.0);
  points.insert(points.begin() + 5, {points[5], points[5], points[5]});
  points.push_back(points.back());
  const auto prepared = prepare({recording(points)});
  ASSERT_EQ(prepared->lines.size(), 1u);
  const NavigationLine& line = prepared->lines[0];
  ASSERT_EQ(line.points.size(), 21u);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    EXPECT_NEAR(line.points[i].s, static_cast<double>(i), 1e-8);
    EXPECT_NEAR(line.points[i].theta, 1.0, 1e-8);
  }
}

TEST(NavigationLines, AreKeptRelativeToTheirFirstPoint) {
  const auto prepared = prepare({recording(straight(Pose2(kUtm, 1.0), 20.0, 1.0))});
  const NavigationLine& line = prepared->lines.at(0);
  EXPECT_EQ(line.origin, kUtm);
  EXPECT_EQ(line.points[0].position, Point2(0.0, 0.0));
  EXPECT_NEAR(line.length, 20.0, 1e-8);
  EXPECT_FALSE(line.closed());
}

TEST(NavigationLines, AreCalledByTheirNamesWhereThoseTellThemApart) {
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  const auto prepared = prepare({recording(points, "left", 0), recording(points, "right", 1)});
  EXPECT_EQ(prepared->lines.at(0).id, "left");
  EXPECT_EQ(prepared->lines.at(1).id, "right");
}

TEST(NavigationLines, HaveUniqueIdsWhateverTheirNames) {
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  for (const std::vector<std::string>& names : std::vector<std::vector<std::string>>{
           {"a", "a", "a"}, {"", "", "a"}, {"line_1_a", "a", "a"}, {"a", "a", "line_0_a", "line_1_a"}}) {
    std::vector<RecordedLine> lines;
    for (const std::string& name : names) lines.push_back(recording(points, name));
    const auto prepared = prepare(lines), again = prepare(lines);
    std::set<std::string> ids;
    for (std::size_t i = 0; i < names.size(); ++i) {
      EXPECT_FALSE(prepared->lines.at(i).id.empty());
      EXPECT_TRUE(ids.insert(prepared->lines.at(i).id).second)
          << prepared->lines.at(i).id << " is there twice";
      EXPECT_EQ(prepared->lines.at(i).id, again->lines.at(i).id) << "the same when sent again";
      EXPECT_EQ(prepared->lines.at(i).name, names[i]);
    }
  }
}

TEST(NavigationLines, KeepDifferentPriorities) {
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  const auto prepared =
      prepare({recording(points, "a", 7), recording(points, "b", 0), recording(points, "c", 3)});
  EXPECT_EQ(prepared->lines.at(0).priority, 7u);
  EXPECT_EQ(prepared->lines.at(1).priority, 0u);
  EXPECT_EQ(prepared->lines.at(2).priority, 3u);
  EXPECT_TRUE(prepared->faults.empty());
}

TEST(NavigationLines, WithoutPriorityZeroAreTold) {
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  const auto prepared = prepare({recording(points, "a", 7), recording(points, "b", 3)});
  EXPECT_THAT(prepared->faults,
              testing::ElementsAre("path_priority of the best line, 'b', is 3, not 0: it counts as 0"));
}

TEST(NavigationLines, GetDifferentPrioritiesWhereTheyRepeat) {
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  const auto prepared =
      prepare({recording(points, "a", 0), recording(points, "b", 0), recording(points, "c", 1)});
  EXPECT_EQ(prepared->lines.at(0).priority, 0u);
  EXPECT_EQ(prepared->lines.at(1).priority, 1u) << "the later one moves back";
  EXPECT_EQ(prepared->lines.at(2).priority, 2u);
  EXPECT_THAT(prepared->faults,
              testing::ElementsAre("path_priority of line 'b' is 0, which is taken: it now has "
                                   "priority 1, and 1 more lines move back as well"));
}

TEST(NavigationLines, OfAnInfiniteNumberAreToldAndUsed) {
  for (double LinePoint::*field : {&LinePoint::theta, &LinePoint::kappa, &LinePoint::dkappa, &LinePoint::s}) {
    RecordedLine line = recording(straight(Pose2(), 50.0, 1.0), "a");
    line.points[5].*field = -std::numeric_limits<double>::infinity();
    const auto prepared = prepare({line});
    ASSERT_EQ(prepared->lines.size(), 1u);
    ASSERT_EQ(prepared->faults.size(), 1u);
    EXPECT_THAT(prepared->faults[0], testing::StartsWith("line 'a': path_point[5]."));
    EXPECT_THAT(prepared->faults[0], HasSubstr("is -inf: computed from the positions"));
  }
}

TEST(NavigationLines, ByTheThousandAreTold) {
  const Polyline points = straight(Pose2(), 2.0, 1.0);
  std::vector<RecordedLine> lines;
  for (std::uint32_t i = 0; i < 1001; ++i) lines.push_back(recording(points, std::to_string(i), i));
  EXPECT_THAT(prepare(lines)->faults, testing::ElementsAre(HasSubstr("navigation_path has 1001 lines")));
  lines.pop_back();
  EXPECT_TRUE(prepare(lines)->faults.empty());
}

TEST(NavigationLines, OfTheWorstPriorityStayTheWorst) {
  constexpr std::uint32_t kWorst = std::numeric_limits<std::uint32_t>::max();
  const Polyline points = straight(Pose2(), 50.0, 1.0);
  const auto prepared =
      prepare({recording(points, "a", kWorst), recording(points, "b", kWorst), recording(points, "c", 1)});
  EXPECT_LT(prepared->lines.at(0).priority, prepared->lines.at(1).priority);
  EXPECT_LT(prepared->lines.at(2).priority, prepared->lines.at(0).priority);
}

/// A left-hand arc as a smoother would write it: with its own theta, kappa and dkappa.
RecordedLine smoothed_arc() {
  RecordedLine line = recording(test::arc(Pose2(kUtm, 3.0), 0.02, 60.0, 0.5));
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    line.points[i].theta = normalize_angle(3.0 + 0.01 * static_cast<double>(i));
    line.points[i].kappa = 0.02 + 1e-4;
    line.points[i].dkappa = 1e-4;
    line.points[i].s = 100.0 + 0.5 * static_cast<double>(i);
  }
  return line;
}

TEST(NavigationLines, KeepTheirOwnGeometryWhereItAgrees) {
  const auto prepared = prepare({smoothed_arc()});
  for (const PathPoint& point : prepared->lines.at(0).points) {
    EXPECT_EQ(point.kappa, 0.02 + 1e-4);
    EXPECT_EQ(point.dkappa, 1e-4);
    EXPECT_NEAR(std::atan2(point.direction.y(), point.direction.x()), point.theta, 1e-15);
  }
  EXPECT_EQ(prepared->lines.at(0).points[3].theta, smoothed_arc().points[3].theta);
}

TEST(NavigationLines, HaveTheirOwnArcLengthWhateverWasRecorded) {
  const auto prepared = prepare({smoothed_arc()});
  EXPECT_EQ(prepared->lines.at(0).points[0].s, 0.0);
  const double chord = 2.0 / 0.02 * std::sin(0.5 * 0.02 * 0.5);
  EXPECT_NEAR(prepared->lines.at(0).points[10].s, 10.0 * chord, 1e-7);
}

void expect_recomputed(const RecordedLine& line) {
  const auto prepared = prepare({line});
  const PathPoints& points = prepared->lines.at(0).points;
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_NEAR(angle_difference(points[i].theta, 3.0 + 0.01 * static_cast<double>(i)), 0.0, 1e-7);
    EXPECT_NEAR(points[i].kappa, 0.02, 1e-6);
  }
}

TEST(NavigationLines, GetTheGeometryOfTheirPositionsWhereTheirOwnIsMissing) {
  RecordedLine line = smoothed_arc();
  line.points[40].theta = kNaN;
  expect_recomputed(line);
  line = smoothed_arc();
  line.points[40].kappa = kNaN;
  expect_recomputed(line);
}

TEST(NavigationLines, GetTheGeometryOfTheirPositionsWhereTheirOwnIsWrong) {
  RecordedLine zeros = smoothed_arc();
  for (LinePoint& point : zeros.points) point.theta = point.kappa = point.dkappa = 0.0;
  expect_recomputed(zeros);
  RecordedLine compass = smoothed_arc();  // clockwise from north
  for (LinePoint& point : compass.points) point.theta = normalize_angle(kPi / 2.0 - point.theta);
  expect_recomputed(compass);
  RecordedLine mirrored = smoothed_arc();
  for (LinePoint& point : mirrored.points) point.kappa = -point.kappa;
  expect_recomputed(mirrored);
}

TEST(NavigationLines, GetTheGeometryOfTheirPositionsWhereTheirOwnDoesNotFitLongSegments) {
  // Each number is near enough by itself, but 8 m on, curvature and heading are apart.
  RecordedLine line = recording(test::arc(Pose2(kUtm, 3.0), 0.02, 120.0, 8.0));
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    line.points[i].theta = normalize_angle(3.0 + 0.16 * static_cast<double>(i) + 0.0045);
    line.points[i].kappa = 0.02 - 0.0015 * (i % 2 == 0 ? 1.0 : -1.0);
    line.points[i].dkappa = 0.0;
  }
  const auto prepared = prepare({line});
  for (const PathPoint& point : prepared->lines.at(0).points) EXPECT_NEAR(point.kappa, 0.02, 1e-6);
}

TEST(NavigationLines, GetTheGeometryOfTheirPositionsWhereTheirOwnCurvatureDoesNotAddUpOnTheLastMetres) {
  RecordedLine line = recording(straight(Pose2(kUtm, 3.0), 4.0, 0.5));
  for (LinePoint& point : line.points) point.theta = 3.0, point.kappa = 0.004, point.dkappa = 0.0;
  const auto prepared = prepare({line});
  for (const PathPoint& point : prepared->lines.at(0).points) EXPECT_NEAR(point.kappa, 0.0, 1e-6);
}

TEST(NavigationLines, GetTheRatesOfTheirPositionsWhereTheirOwnAreMissing) {
  RecordedLine line = smoothed_arc();
  for (LinePoint& point : line.points) point.dkappa = kNaN;
  const auto prepared = prepare({line});
  EXPECT_EQ(prepared->lines.at(0).points[3].kappa, 0.02 + 1e-4) << "theta and kappa stay";
  EXPECT_NEAR(prepared->lines.at(0).points[3].dkappa, 0.0, 1e-5);
}

TEST(NavigationLines, KnowWhenTheyAreThinned) {
  Polyline thinned = straight(Pose2(), 100.0, 10.0);
  const Polyline dense = straight(Pose2(Point2(110.0, 0.0), 0.0), 20.0, 1.0);
  thinned.insert(thinned.end(), dense.begin(), dense.end());
  EXPECT_TRUE(prepare({recording(thinned)})->lines.at(0).thinned);
  Polyline even = straight(Pose2(), 100.0, 10.0);
  even.push_back(Point2(101.0, 0.0));
  EXPECT_FALSE(prepare({recording(even)})->lines.at(0).thinned) << "the last step may be of any length";
}

TEST(NavigationLines, HaveOneVertexWherePointsAreAHairApart) {
  Polyline points = straight(Pose2(), 50.0, 1.0);
  points.insert(points.begin() + 20, points[20] + Point2(5e-4, 0.0));
  EXPECT_EQ(prepare({recording(points, "a")})->lines.at(0).points.size(), 51u);
}

}  // namespace
}  // namespace relative_map::core
