// What receivers do: noise, drift, single fixes that jump, and orientations that were never filled.
#include <gmock/gmock.h>

#include <cmath>

#include "relative_map/simulation/random_process.hpp"
#include "relative_map/tools/line_recorder.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using testing::HasSubstr;

constexpr double kX = 690000.0, kY = 3118000.0;  // as in a UTM zone

/// Ways along x: a speed [m/s], held for a time [s].
struct Leg {
  double speed, duration;
};

/// At `rate` [Hz], without headings.
std::vector<RecordedPose> drive(const std::vector<Leg>& legs, double rate = 10.0) {
  std::vector<RecordedPose> poses;
  double x = kX, stamp = 1.7e9;
  for (const Leg& leg : legs) {
    const int count = static_cast<int>(std::lround(leg.duration * rate));
    for (int i = 0; i < count; ++i, stamp += 1.0 / rate, x += leg.speed / rate) {
      poses.push_back({stamp, x, kY, 5.0, kNaN});
    }
  }
  return poses;
}

std::vector<RecordedPose> noisy(std::vector<RecordedPose> poses, double standard_deviation,
                                std::uint64_t seed = 3) {
  NoiseSource noise(seed, 1);
  for (RecordedPose& pose : poses) {
    pose.x += noise.draw(standard_deviation);
    pose.y += noise.draw(standard_deviation);
  }
  return poses;
}

std::vector<RecordedPose> drifting(std::vector<RecordedPose> poses, double standard_deviation,
                                   double time_constant, std::uint64_t seed) {
  OrnsteinUhlenbeck x(standard_deviation, time_constant, NoiseSource(seed, 1));
  OrnsteinUhlenbeck y(standard_deviation, time_constant, NoiseSource(seed, 2));
  for (RecordedPose& pose : poses) {
    pose.x += x.at(pose.stamp);
    pose.y += y.at(pose.stamp);
  }
  return poses;
}

/// Neither a gap nor a way back, by more than noise does.
void expect_one_way(const RecordedLine& line, double length, double noise) {
  ASSERT_GT(line.points.size(), 2u);
  EXPECT_NEAR(line.points.front().x - kX, 0.0, 1.0 + 4.0 * noise);
  EXPECT_NEAR(line.points.back().x - kX, length, 2.0 + 4.0 * noise);
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    EXPECT_GT(line.points[i].x, line.points[i - 1].x) << i;
    EXPECT_LT(line.points[i].x, line.points[i - 1].x + 1.5 + 6.0 * noise) << i;
  }
}

TEST(LineRecorderNoise, ParkedNoiseIsNoMotion) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (double rate : {1.0, 10.0, 50.0}) {
      for (double noise : {0.1, 0.5, 1.0, 2.0}) {
        const Recording parked = record_line(noisy(drive({{0.0, 300.0}}, rate), noise, seed), {});
        EXPECT_EQ(parked.moving, 0u) << "seed " << seed << ", " << rate << " Hz, " << noise << " m";
        EXPECT_TRUE(parked.line.points.empty());
      }
    }
  }
}

TEST(LineRecorderNoise, AParkedReceiversDriftIsNoMotion) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (double time : {20.0, 60.0}) {
      const Recording parked = record_line(drifting(drive({{0.0, 300.0}}), 0.5, time, seed), {});
      EXPECT_EQ(parked.moving, 0u) << seed << ", " << time;
    }
  }
}

TEST(LineRecorderNoise, AStopWithNoiseMakesNoKnotAndNoReversing) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Recording recording = record_line(
        noisy(drive({{0.0, 60.0}, {5.0, 20.0}, {0.0, 120.0}, {5.0, 20.0}, {0.0, 60.0}}), 0.5, seed), {});
    EXPECT_EQ(recording.reversing, 0u);
    EXPECT_EQ(recording.taken_back, 0u);
    EXPECT_NEAR(static_cast<double>(recording.standing), 2400.0, 40.0);
    EXPECT_NEAR(recording.noise, 0.5, 0.05);
    expect_one_way(recording.line, 200.0, 0.5);
  }
}

TEST(LineRecorderNoise, CreepingInATrafficJamIsMotion) {
  std::vector<Leg> jam;
  for (int i = 0; i < 20; ++i) jam.insert(jam.end(), {{0.0, 10.0}, {1.0, 3.0}});
  expect_one_way(record_line(noisy(drive(jam), 0.02), {}).line, 60.0, 0.02);
}

TEST(LineRecorderNoise, ReversingIsSeenThroughNoise) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const Recording recording = record_line(
        noisy(drive({{5.0, 10.0}, {0.0, 5.0}, {-2.0, 10.0}, {0.0, 5.0}, {5.0, 10.0}}), 0.3, seed), {});
    EXPECT_NEAR(static_cast<double>(recording.reversing), 100.0, 10.0);
    expect_one_way(recording.line, 80.0, 0.3);
  }
}

/// A robot that goes round three sides of a block, with sharp corners.
std::vector<RecordedPose> round_the_block(double speed, double rate) {
  const Polyline corners = {{0.0, 0.0}, {-20.0, 60.0}, {20.0, 80.0}, {30.0, 20.0}};
  std::vector<RecordedPose> poses;
  double stamp = 1.7e9;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    const Point2 way = corners[i] - corners[i - 1];
    const int count = static_cast<int>(way.norm() / speed * rate);
    for (int k = 0; k < count; ++k, stamp += 1.0 / rate) {
      const Point2 at = corners[i - 1] + way * k / count;
      poses.push_back({stamp, kX + at.x(), kY + at.y(), 5.0, kNaN});
    }
    for (int k = 0; k < static_cast<int>(2.0 * rate); ++k, stamp += 1.0 / rate) {  // it turns on the spot
      poses.push_back({stamp, kX + corners[i].x(), kY + corners[i].y(), 5.0, kNaN});
    }
  }
  return poses;
}

TEST(LineRecorderNoise, ASlowRobotInNoiseKeepsItsWay) {
  for (double rate : {2.5, 10.0}) {
    for (double noise : {0.08, 0.3, 0.8}) {
      for (std::uint64_t seed = 0; seed < 5; ++seed) {
        SCOPED_TRACE(testing::Message() << rate << " Hz, " << noise << " m, seed " << seed);
        const Recording recording = record_line(noisy(round_the_block(1.0, rate), noise, seed), {});
        EXPECT_EQ(recording.fault, "");
        EXPECT_GT(recording.way.share(), 0.85);
        EXPECT_NEAR(recording.way.kept + recording.way.lost, 169.0, 12.0 + 30.0 * noise);
        EXPECT_EQ(recording.reversing, 0u);
        ASSERT_FALSE(recording.line.points.empty());
        EXPECT_NEAR(recording.line.points.front().x - kX, 0.0, 2.0 + 4.0 * noise);
        EXPECT_NEAR(recording.line.points.back().y - kY, 20.0, 2.0 + 4.0 * noise);
      }
    }
  }
}

TEST(LineRecorderNoise, WhatScattersTooMuchIsNoLine) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    for (double rate : {1.0, 10.0}) {
      SCOPED_TRACE(testing::Message() << rate << " Hz, seed " << seed);
      const Recording canyon = record_line(noisy(drive({{10.0, 155.0}}, rate), 21.0, seed), {});
      EXPECT_NE(canyon.fault, "");
      EXPECT_THAT(canyon.fault, testing::ContainsRegex("standard deviation of (1[6-9]|2[0-3])\\."));
      EXPECT_LT(canyon.way.share(), 0.5);
    }
  }
}

TEST(LineRecorderNoise, AStretchThatScattersIsAGapAndIsTold) {
  std::vector<RecordedPose> poses = noisy(drive({{10.0, 100.0}}), 0.1);
  const std::vector<RecordedPose> bad = noisy(drive({{10.0, 100.0}}), 21.0);
  std::copy(bad.begin() + 400, bad.begin() + 600, poses.begin() + 400);
  const Recording recording = record_line(poses, {});
  EXPECT_EQ(recording.fault, "");
  EXPECT_GT(recording.scattered, 100u);
  EXPECT_NEAR(recording.way.share(), 0.8, 0.05);
  double longest = 0.0;
  for (std::size_t i = 1; i < recording.line.points.size(); ++i) {
    longest = std::max(longest, recording.line.points[i].x - recording.line.points[i - 1].x);
  }
  EXPECT_NEAR(longest, 200.0, 30.0);
}

TEST(LineRecorderNoise, FixesThatAreStatedToBeBadAreLeftOut) {
  std::vector<RecordedPose> poses = noisy(drive({{10.0, 100.0}}), 0.1);
  for (RecordedPose& pose : poses) pose.deviation = 0.8;
  for (std::size_t i = 400; i < 500; ++i) poses[i].deviation = 21.0;
  const Recording recording = record_line(poses, {});
  EXPECT_EQ(recording.fault, "");
  EXPECT_EQ(recording.doubtful, 100u);
  EXPECT_NEAR(recording.way.lost, 100.0, 10.0);
  for (RecordedPose& pose : poses) pose.deviation = 21.0;
  EXPECT_THAT(record_line(poses, {}).fault, HasSubstr("all of its 1000 poses are stated to be worse"));
  RecorderParam careless;
  careless.max_noise = 30.0;
  EXPECT_EQ(record_line(poses, careless).fault, "");
}

TEST(LineRecorderNoise, IsNamedWhereItHidesAllMotion) {
  const std::string fault = record_line(noisy(drive({{0.0, 60.0}}), 1.0), {}).fault;
  EXPECT_THAT(fault, HasSubstr("the vehicle has not moved forward"));
  EXPECT_THAT(fault, testing::ContainsRegex("noise, of a standard deviation of (0.9.?|1|1.0.?) m"));
  EXPECT_EQ(record_line(drive({{0.0, 60.0}}), {}).fault, "the vehicle has not moved forward");
}

TEST(LineRecorderNoise, ASingleOutlierIsDroppedAndTold) {
  for (double rate : {1.0, 10.0}) {
    for (double noise : {0.0, 0.5}) {
      const std::vector<RecordedPose> good = noisy(drive({{0.0, 10.0}, {10.0, 30.0}}, rate), noise);
      for (std::size_t i : {std::size_t{0}, std::size_t{1}, std::size_t{5}, good.size() / 2, good.size() - 2,
                            good.size() - 1}) {
        SCOPED_TRACE(testing::Message() << "rate " << rate << ", noise " << noise << ", pose " << i);
        std::vector<RecordedPose> poses = good, others = good;
        poses[i].y += 20.0;
        others.erase(others.begin() + static_cast<std::ptrdiff_t>(i));
        const Recording recording = record_line(poses, {}), expected = record_line(others, {});
        ASSERT_EQ(recording.outliers.size(), 1u);
        EXPECT_EQ(recording.outliers[0].pose, i);
        EXPECT_EQ(recording.outliers[0].stamp, poses[i].stamp);
        EXPECT_NEAR(recording.outliers[0].distance, 20.0, 8.0 * noise);
        ASSERT_EQ(recording.line.points.size(), expected.line.points.size());
        for (std::size_t k = 0; k < expected.line.points.size(); ++k) {
          EXPECT_EQ(recording.line.points[k].y, expected.line.points[k].y);
        }
      }
    }
  }
}

TEST(LineRecorderNoise, AnOutlierMayLieInAnotherZone) {
  std::vector<RecordedPose> poses = drive({{5.0, 20.0}});
  poses[77].x -= 400000.0;
  const Recording recording = record_line(poses, {});
  EXPECT_EQ(recording.fault, "");
  EXPECT_EQ(recording.outliers.size(), 1u);
}

TEST(LineRecorderNoise, AStepThatStaysIsNoOutlier) {
  std::vector<RecordedPose> poses = drive({{5.0, 20.0}});
  for (std::size_t i = 77; i < poses.size(); ++i) poses[i].y += 20.0;
  EXPECT_TRUE(record_line(poses, {}).outliers.empty());
}

TEST(LineRecorderNoise, DrivingHasNoOutliers) {
  std::vector<RecordedPose> pause = drive({{10.0, 20.0}});  // the receiver was silent for 4 s
  pause.erase(pause.begin() + 50, pause.begin() + 90);
  const Recording recording = record_line(pause, {});
  EXPECT_TRUE(recording.outliers.empty());
  EXPECT_EQ(recording.fault, "");
  std::vector<RecordedPose> lonely = drive({{10.0, 9.0}, {0.0, 9.0}});  // one pose in a silence, braking
  lonely.erase(lonely.begin() + 91, lonely.begin() + 130);
  lonely.erase(lonely.begin() + 51, lonely.begin() + 90);
  EXPECT_TRUE(record_line(lonely, {}).outliers.empty());
}

/// A lap, counter-clockwise.
std::vector<RecordedPose> lap() {
  std::vector<RecordedPose> poses;
  for (int i = 0; i < 600; ++i) {
    const Pose2 pose = test::along_arc(Pose2({kX, kY}, 0.0), 0.02, 0.5 * i);
    poses.push_back({1.7e9 + 0.1 * i, pose.position().x(), pose.position().y(), 5.0, pose.heading()});
  }
  return poses;
}

TEST(LineRecorderNoise, HeadingsThatWereNeverFilledAreNotUsed) {
  std::vector<RecordedPose> poses = lap();
  const Recording good = record_line(poses, {});
  EXPECT_TRUE(good.headings_used);
  EXPECT_EQ(good.sideways, 0u);
  for (RecordedPose& pose : poses) pose.heading = 0.0;
  const Recording recording = record_line(poses, {});
  EXPECT_FALSE(recording.headings_used);
  EXPECT_GT(recording.sideways, 100u);
  EXPECT_EQ(recording.reversing, 0u);
  EXPECT_EQ(recording.line.points.size(), good.line.points.size());
}

}  // namespace
}  // namespace relative_map::core
