// Clocks that are set while a line is recorded, and two receivers on one topic.
#include "relative_map/tools/clock_faults.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/simulation/random_process.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using testing::HasSubstr;

constexpr double kStart = 1.7e9;

/// A way of 200 m in a curve at 10 m/s; received some time later than it is stamped.
std::vector<RecordedPose> drive(double rate, double noise = 0.02) {
  NoiseSource source(3, 1);
  std::vector<RecordedPose> poses;
  for (int i = 0; i < static_cast<int>(20.0 * rate); ++i) {
    const Pose2 pose = test::along_arc(Pose2({690000.0, 3118000.0}, 0.3), 0.005, 10.0 * i / rate);
    RecordedPose recorded{kStart + i / rate, pose.position().x() + source.draw(noise),
                          pose.position().y() + source.draw(noise), 5.0, kNaN};
    recorded.received = recorded.stamp + 0.03 + std::abs(source.draw(0.01));
    poses.push_back(recorded);
  }
  return poses;
}

double length_of(const RecordedLine& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length += std::hypot(line.points[i].x - line.points[i - 1].x, line.points[i].y - line.points[i - 1].y);
  }
  return length;
}

void expect_whole_way(const std::vector<RecordedPose>& poses) {
  for (std::size_t i = 1; i < poses.size(); ++i) ASSERT_GE(poses[i].stamp, poses[i - 1].stamp) << i;
  const Recording recording = record_line(poses, {});
  EXPECT_EQ(recording.fault, "");
  const double last = 10.0 * (poses.back().stamp - poses.front().stamp);  // it drives at 10 m/s
  EXPECT_NEAR(length_of(recording.line), last, 0.03 * last);
  EXPECT_GT(recording.way.share(), 0.97);
}

TEST(ClockFaults, AClockThatIsSetBackIsMended) {
  for (double rate : {2.0, 5.0, 20.0, 100.0}) {
    for (double back : {0.5, 2.0, 3600.0}) {
      SCOPED_TRACE(testing::Message() << rate << " Hz, " << back << " s");
      std::vector<RecordedPose> poses = drive(rate);
      const std::size_t half = poses.size() / 2;
      for (std::size_t i = half; i < poses.size(); ++i) poses[i].stamp -= back;
      const std::vector<ClockStep> steps = mend_clock(poses);
      expect_whole_way(poses);
      if (rate * back <= 1.0) continue;  // the stamps never go back
      ASSERT_EQ(steps.size(), 1u);
      EXPECT_EQ(steps[0].pose, half);
      EXPECT_NEAR(steps[0].step, -back, 0.1);
    }
  }
}

TEST(ClockFaults, StampsThatFallToAnotherYearAreMended) {
  for (double rate : {1.0, 5.0, 20.0}) {
    SCOPED_TRACE(rate);
    std::vector<RecordedPose> poses = drive(rate);
    for (std::size_t i = poses.size() / 2; i < poses.size() / 2 + static_cast<std::size_t>(2.0 * rate); ++i) {
      poses[i].stamp -= kStart - 315964800.0;  // 1980
    }
    const std::vector<ClockStep> steps = mend_clock(poses);
    EXPECT_EQ(steps.size(), 2u);
    expect_whole_way(poses);
  }
}

TEST(ClockFaults, AClockThatIsSetForwardOrStandsIsMended) {
  std::vector<RecordedPose> poses = drive(20.0);
  for (std::size_t i = 100; i < poses.size(); ++i) poses[i].stamp += 3600.0;
  EXPECT_EQ(mend_clock(poses).size(), 1u);
  expect_whole_way(poses);
  poses = drive(20.0);
  for (std::size_t i = 100; i < 160; ++i) poses[i].stamp = poses[100].stamp;
  const std::vector<ClockStep> steps = mend_clock(poses);
  ASSERT_EQ(steps.size(), 1u);
  EXPECT_EQ(steps[0].step, 0.0);
  expect_whole_way(poses);
}

TEST(ClockFaults, LateMessagesAndStallsAreNoFaultsOfAClock) {
  std::vector<RecordedPose> poses = drive(20.0);
  for (std::size_t i = 50; i < 300; i += 17) std::swap(poses[i], poses[i + 1]);  // one overtakes another
  for (std::size_t i = 50; i < 300; i += 17) std::swap(poses[i].received, poses[i + 1].received);
  for (std::size_t i = 200; i < 260; ++i)
    poses[i].received = poses[260].received;  // a network that was stuck
  EXPECT_TRUE(mend_clock(poses).empty());
  expect_whole_way(poses);
}

TEST(ClockFaults, OneDriveIsOneSource) {
  for (double rate : {1.0, 2.5, 10.0, 50.0}) {
    for (double noise : {0.0, 0.02, 0.5, 2.0}) {
      EXPECT_TRUE(find_two_sources(drive(rate, noise)).empty()) << rate << " Hz, " << noise << " m";
    }
  }
}

TEST(ClockFaults, TwoReceiversOnOneTopicAreNamed) {
  for (double phase : {0.0, 0.03, 0.05}) {
    SCOPED_TRACE(phase);
    std::vector<RecordedPose> poses;
    for (const RecordedPose& pose : drive(10.0)) {
      poses.push_back(pose);
      poses.push_back(pose);
      poses.back().stamp += phase;
      poses.back().x += 10.0 * phase;
      poses.back().y += 1.2;
    }
    EXPECT_EQ(find_two_sources(poses).size(), 1u);
    EXPECT_THAT(record_line(poses, {}).fault, HasSubstr("there are two sources on one topic"));
  }
}

TEST(ClockFaults, ADriveThatIsWovenIntoItselfIsNamed) {
  for (double back : {0.5, 2.0}) {
    std::vector<RecordedPose> poses = drive(20.0);
    for (std::size_t i = 200; i < poses.size(); ++i) {
      poses[i].stamp -= back;
      poses[i].received -= back;
    }
    // As a bag gives them: by the time of the recording, which was set back, too.
    std::stable_sort(poses.begin(), poses.end(),
                     [](const RecordedPose& a, const RecordedPose& b) { return a.received < b.received; });
    mend_clock(poses);
    EXPECT_THAT(record_line(poses, {}).fault, HasSubstr("the clock of the recording was set back")) << back;
  }
}

}  // namespace
}  // namespace relative_map::core
