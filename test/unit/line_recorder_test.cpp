#include "relative_map/tools/line_recorder.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/simulation/noise.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using testing::HasSubstr;

/// A drive along x at 10 Hz: a list of speeds [m/s], each held for a time [s].
struct Leg {
  double speed, duration;
};

std::vector<RecordedPose> drive(const std::vector<Leg>& legs, bool with_heading, double noise = 0.0) {
  NoiseSource source(3, 1);
  std::vector<RecordedPose> poses;
  double x = 690000.0, stamp = 1.7e9;
  for (const Leg& leg : legs) {
    for (int i = 0; i < static_cast<int>(leg.duration * 10.0); ++i, stamp += 0.1, x += 0.1 * leg.speed) {
      poses.push_back(
          {stamp, x + source.draw(noise), 3118000.0 + source.draw(noise), 5.0, with_heading ? 0.0 : kNaN});
    }
  }
  return poses;
}

void expect_forward(const RecordedLine& line, double from, double to) {
  ASSERT_GT(line.points.size(), 2u);
  EXPECT_NEAR(line.points.front().x - 690000.0, from, 1.5);
  EXPECT_NEAR(line.points.back().x - 690000.0, to, 2.0);
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    EXPECT_GE(line.points[i].x - line.points[i - 1].x, 0.5 - 1e-6) << i;
    EXPECT_LE(line.points[i].x - line.points[i - 1].x, 2.1) << i;
  }
}

TEST(LineRecorder, SamplesByDistance) {
  const Recording recording = record_line(drive({{4.0, 10.0}}, true), {});
  EXPECT_EQ(recording.fault, "");
  expect_forward(recording.line, 0.0, 39.6);
  EXPECT_NEAR(static_cast<double>(recording.line.points.size()), 50.0, 2.0);  // each second pose
  EXPECT_EQ(recording.line.points[3].z, 5.0);
  EXPECT_TRUE(std::isnan(recording.line.points[3].theta));
}

TEST(LineRecorder, StandingStillAddsNothing) {
  const Recording still = record_line(drive({{5.0, 10.0}, {0.0, 60.0}, {5.0, 10.0}}, false), {});
  EXPECT_GT(still.standing, 500u);
  expect_forward(still.line, 0.0, 99.0);
  // Nor does noise while it stands.
  const Recording noisy = record_line(drive({{5.0, 10.0}, {0.0, 60.0}, {5.0, 10.0}}, false, 0.1), {});
  EXPECT_LT(noisy.line.points.size(), still.line.points.size() + 10);
}

TEST(LineRecorder, ReversingTakesTheLineBack) {
  for (bool with_heading : {true, false}) {
    SCOPED_TRACE(with_heading);
    const Recording recording = record_line(
        drive({{5.0, 10.0}, {0.0, 3.0}, {-2.0, 10.0}, {0.0, 3.0}, {5.0, 10.0}}, with_heading), {});
    EXPECT_EQ(recording.fault, "");
    EXPECT_GT(recording.reversing, 80u);
    EXPECT_GT(recording.taken_back, 20u);
    expect_forward(recording.line, 0.0, 80.0);
  }
}

TEST(LineRecorder, AStartInReverseIsKnownByTheHeading) {
  const Recording recording = record_line(drive({{-2.0, 10.0}, {0.0, 3.0}, {5.0, 10.0}}, true), {});
  expect_forward(recording.line, -20.0, 30.0);
}

TEST(LineRecorder, DuplicateStampsAndPosesDoNoHarm) {
  std::vector<RecordedPose> poses = drive({{5.0, 10.0}}, false), twice;
  for (const RecordedPose& pose : poses) twice.insert(twice.end(), 2, pose);
  EXPECT_EQ(record_line(twice, {}).line.points.size(), record_line(poses, {}).line.points.size());
}

TEST(LineRecorder, JumpsAndNonsenseAreFaults) {
  std::vector<RecordedPose> poses = drive({{5.0, 10.0}}, true);
  for (std::size_t i = 50; i < poses.size(); ++i) poses[i].x -= 400000.0;
  EXPECT_THAT(record_line(poses, {}).fault, HasSubstr("its zone or its origin"));
  poses[20].y = kNaN;
  EXPECT_THAT(record_line(poses, {}).fault, HasSubstr("pose 20"));
  EXPECT_THAT(record_line({}, {}).fault, HasSubstr("no poses"));
  EXPECT_THAT(record_line(drive({{0.0, 30.0}}, true), {}).fault, HasSubstr("not moved forward"));
}

}  // namespace
}  // namespace relative_map::core
