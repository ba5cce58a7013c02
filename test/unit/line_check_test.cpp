#include "relative_map/tools/line_check.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/simulation/road.hpp"
#include "relative_map/tools/editable_line.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::recording;
using test::straight;

std::vector<LineFault> faults_of(const RecordedLine& line, const LineHeader& header = {}) {
  return check_line(line, header, {});
}

/// The only fault, which must be of this kind.
LineFault only_fault(const RecordedLine& line, const std::string& kind, const LineHeader& header = {}) {
  const std::vector<LineFault> faults = faults_of(line, header);
  EXPECT_EQ(faults.size(), 1u) << kind
                               << (faults.size() > 1 ? ", " + faults[1].kind + ": " + faults[1].what : "");
  if (faults.empty()) return {};
  EXPECT_EQ(faults[0].kind, kind) << faults[0].what;
  EXPECT_THAT(line_fault_kinds(), testing::Contains(kind));
  return faults[0];
}

LineHeader utm50() {
  LineHeader header;
  header.reference.projection = Projection::kUtm;
  header.reference.zone = 50;
  return header;
}

TEST(LineCheck, GoodLinesHaveNoFault) {
  const Pose2 start({690000.0, 3118000.0}, 0.3);
  for (const RecordedLine& line : {demo_road(start).lane(0.0, 0.5), closed_road(start).lane(3.5, 1.0),
                                   RoadShape(start)
                                       .add_straight(9.0)
                                       .add_clothoid(5.0, 0.2)
                                       .add_arc(2.8, 0.2)
                                       .add_clothoid(5.0, 0.0)
                                       .add_straight(9.0)
                                       .lane(0.0, 0.5)}) {
    const std::vector<LineFault> faults = faults_of(line, utm50());
    EXPECT_TRUE(faults.empty()) << faults[0].kind << ": " << faults[0].what;
  }
}

TEST(LineCheck, FindsAGap) {
  RecordedLine line = recording(straight({}, 100.0, 0.5));
  line.points.erase(line.points.begin() + 40, line.points.begin() + 60);
  const LineFault fault = only_fault(line, "gap");
  EXPECT_EQ(fault.point, 40u);
  EXPECT_NEAR(fault.s, 19.5, 1e-9);
}

TEST(LineCheck, TakesAJumpForAnotherZone) {
  RecordedLine line = recording(straight({}, 100.0, 0.5));
  for (std::size_t i = 100; i < line.points.size(); ++i) line.points[i].x += 400000.0;
  EXPECT_THAT(only_fault(line, "gap").what, testing::HasSubstr("another zone or origin"));
}

TEST(LineCheck, FindsDuplicatesOnce) {
  RecordedLine line = recording(straight({}, 100.0, 0.5));
  line.points.insert(line.points.begin() + 10, 3, line.points[10]);
  const LineFault fault = only_fault(line, "duplicate");
  EXPECT_EQ(fault.point, 11u);
  EXPECT_EQ(fault.count, 3u);
}

TEST(LineCheck, FindsSThatGoesBackOrIsWrong) {
  RecordedLine line = demo_road().lane(0.0, 0.5);
  std::swap(line.points[10].s, line.points[11].s);
  EXPECT_EQ(faults_of(line).size(), 3u);  // wrong, backward, wrong
  EXPECT_EQ(faults_of(line)[1].kind, "backward s");
  EXPECT_EQ(faults_of(line)[1].point, 11u);
  for (LinePoint& point : line.points) point.s = point.x;
  EXPECT_EQ(faults_of(line)[0].kind, "wrong s");
}

TEST(LineCheck, FindsALineThatTurnsBackOrHasAKink) {
  Polyline points = straight({}, 50.0, 1.0);
  for (double x = 49.0; x > 40.0; x -= 1.0) points.emplace_back(x, 0.0);
  EXPECT_EQ(faults_of(recording(points))[0].kind, "backward");
  EXPECT_EQ(faults_of(recording(points))[0].point, 50u);
  points = straight({}, 50.0, 1.0);
  for (double y = 1.0; y < 50.0; y += 1.0) points.emplace_back(50.0, y);
  EXPECT_EQ(faults_of(recording(points))[0].kind, "kink");
}

TEST(LineCheck, FindsACurveThatIsTooTight) {
  const LineFault fault = only_fault(recording(test::arc({}, 0.3, 15.0, 0.25)), "curvature");
  EXPECT_THAT(fault.what, testing::HasSubstr("0.3 1/m"));
  EXPECT_EQ(fault.count, 61u);
}

TEST(LineCheck, NamesTheWorstOfManyAtItsPlace) {
  RoadShape road;
  road.add_straight(20.0).add_clothoid(20.0, 0.4).add_clothoid(5.0, 0.0).add_straight(20.0);
  RecordedLine line = road.lane(0.0, 0.5);
  const auto of_curvature = [](const RecordedLine& recorded) {
    for (const LineFault& fault : faults_of(recorded)) {
      if (fault.kind == "curvature") return fault;
    }
    return LineFault();
  };
  const LineFault fault = of_curvature(line);
  EXPECT_NEAR(fault.s, 40.0, 0.6);
  EXPECT_GT(fault.count, 10u);
  EXPECT_NEAR(fault.from, 32.5, 1.0);
  EXPECT_NEAR(fault.to, 42.0, 1.0);
  // Points that are there twice do not shift the number.
  line.points.insert(line.points.begin() + 10, 5, line.points[10]);
  EXPECT_EQ(of_curvature(line).point, fault.point + 5);
}

TEST(LineCheck, ABridgedGapIsAFaultUntilItIsAccepted) {
  const RecordedLine line = recording(straight({}, 200.0, 0.5));
  LineHeader header;
  header.bridged = {{50.0, 0.5, 114.0, -0.5}};
  const LineFault fault = only_fault(line, "bridged", header);
  EXPECT_NEAR(fault.s, 50.0, 0.6);
  EXPECT_THAT(fault.what, testing::HasSubstr("nothing was recorded for 64.01 m"));
  LineCheckParam accepting;
  accepting.max_gap = 70.0;
  EXPECT_TRUE(check_line(line, header, accepting).empty());
}

TEST(LineCheck, KnowsWhatTheMapNodeRefuses) {
  const RecordedLine far = recording(straight(Pose2({1.7e9, 10.0}, 0.0), 50.0, 1.0));
  const std::vector<LineFault> faults = faults_of(far);
  ASSERT_FALSE(faults.empty());
  EXPECT_EQ(faults[0].kind, "node");
}

TEST(LineCheck, FindsACurvatureThatNoCarCanSteer) {
  RoadShape road;
  road.add_straight(50.0).add_arc(30.0, 0.06).add_straight(50.0);
  const std::vector<LineFault> faults = faults_of(road.lane(0.0, 0.5));
  ASSERT_EQ(faults.size(), 2u);  // where the arc begins, and where it ends
  EXPECT_EQ(faults[0].kind, "curvature rate");
  EXPECT_NEAR(faults[0].s, 50.0, 1.0);
  EXPECT_NEAR(faults[1].s, 80.0, 1.0);
  LineCheckParam quick;
  quick.max_curvature_rate = 1.0;
  EXPECT_TRUE(check_line(road.lane(0.0, 0.5), {}, quick).empty());
}

/// A lap whose curvature is `before` the seam, and `after` it; elsewhere it changes slowly.
Polyline lap_with_seam(double before, double after) {
  // Such a spiral is closed by a shift that is spread over the lap.
  Polyline points;
  const double turn = 2.0 * kPi, length = turn / (0.5 * (before + after));
  Pose2 pose;
  const int count = static_cast<int>(length / 0.5);
  for (int i = 0; i < count; ++i) {
    points.push_back(pose.position());
    const double kappa = after + (before - after) * (i + 0.5) / count;
    pose = test::along_arc(pose, kappa, length / count);
  }
  const Point2 gap = pose.position();
  for (int i = 0; i < count; ++i) points[i] -= gap * i / count;
  return points;
}

TEST(LineCheck, FindsAStepOfCurvatureAtTheSeamOfALap) {
  const RecordedLine even = recording(lap_with_seam(0.04, 0.04));
  ASSERT_TRUE(make_editable(even).closed());
  EXPECT_TRUE(faults_of(even).empty());
  const RecordedLine line = recording(lap_with_seam(0.08, 0.01));
  ASSERT_TRUE(make_editable(line).closed());
  const LineFault fault = only_fault(line, "curvature rate");
  EXPECT_LT(std::min(fault.s, length_of(make_editable(line)) - fault.s), 1.0);
}

TEST(LineCheck, FindsAKinkAtTheSeamOfALap) {
  Polyline points = test::circle(30.0, 377);
  points[0] += Point2(0.25, 0.0);
  const RecordedLine line = recording(points);
  ASSERT_TRUE(make_editable(line).closed());
  EXPECT_EQ(faults_of(line)[0].kind, "kink");
  EXPECT_EQ(faults_of(line)[0].point, 0u);
}

TEST(LineCheck, FindsHeadingsFromElsewhere) {
  RecordedLine line = demo_road().lane(0.0, 0.5);
  for (LinePoint& point : line.points) point.theta = normalize_angle(0.5 * kPi - point.theta);  // compass
  EXPECT_EQ(faults_of(line)[0].kind, "wrong theta");
}

TEST(LineCheck, FindsALineBesideItself) {
  Polyline twice = test::circle(50.0, 600);
  for (std::size_t i = 0; i < 100; ++i) {  // drifts out by half a metre
    twice.push_back(twice[i] * (1.0 + 1e-4 * static_cast<double>(i)));
  }
  const LineFault fault = only_fault(recording(twice), "overlap");
  EXPECT_NEAR(fault.s, 314.0, 5.0);
  Polyline eight = test::arc({}, 0.02, 310.0, 0.5);  // a crossing is none
  const Polyline other = test::arc({}, -0.02, 310.0, 0.5);
  eight.insert(eight.begin(), other.rbegin(), other.rend());
  for (const LineFault& found : faults_of(recording(eight))) EXPECT_NE(found.kind, "overlap") << found.what;
}

TEST(LineCheck, FindsCoordinatesThatAreNotOfTheirZone) {
  EXPECT_EQ(faults_of(recording(straight(Pose2({-5e6, 0.0}, 0.0), 50.0, 1.0)), utm50())[0].kind, "zone");
  EXPECT_EQ(only_fault(recording(straight(Pose2({11.5, 48.1}, 0.0), 0.001, 1e-5)), "zone").point, 0u);
}

TEST(LineCheck, FindsWhatIsNotFiniteAndTooShort) {
  RecordedLine line = recording(straight({}, 50.0, 1.0));
  line.points[7].y = test::kNaN;
  EXPECT_EQ(only_fault(line, "not finite").point, 7u);
  only_fault(recording({{1.0, 1.0}}), "short");
  for (std::size_t count : {2u, 3u, 50u}) {
    EXPECT_EQ(faults_of(recording(Polyline(count, {1.0, 1.0})))[0].kind, "short");
  }
}

}  // namespace
}  // namespace relative_map::core
