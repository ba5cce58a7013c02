#include <gmock/gmock.h>

#include "support/scene.hpp"
#include "support/straight_drive.hpp"

// One message too many: it is dropped and told, never believed, and nothing is forgotten for it.
namespace relative_map::core {
namespace {

using test::localization_at;
using test::Scene;
using test::StraightDrive;
using test::three_straight_lines;
using testing::HasSubstr;

/// A stamp that does not belong: from the time of the tick.
struct Stray {
  const char* name;
  double since_now;  ///< [s] of its stamp
  bool of_1970 = false;
};
const Stray kStrays[] = {{"repeated", 0.0},
                         {"late by 0.3 s", -0.3},
                         {"late by 0.6 s", -0.6},
                         {"late by a minute", -60.0},
                         {"of 1970", 0.0, true},
                         {"of the future by 0.4 s", 0.4},
                         {"of the future by 0.6 s", 0.6},
                         {"of next year", 3.2e7}};

Time stamp_of(const Stray& stray, Time now) {
  return stray.of_1970 ? at_seconds(1.0) : now + from_seconds(stray.since_now);
}

/// A lane that paint has moved aside from its line: 0.5 m, as localization is off by that.
StraightDrive settled_drive() {
  StraightDrive drive;
  drive.bias = Point2(0.0, 0.5);
  drive.drive(60);
  return drive;
}

void expect_undisturbed(StraightDrive& drive, const std::string& words, const std::string& what) {
  const RelativeMap map = drive.tick(drive.paint());
  EXPECT_EQ(map.status.code, StatusCode::kOk) << what;
  EXPECT_EQ(map.fusion.source, Source::kFused) << what;
  EXPECT_NEAR(drive.error(map, 5.0), 0.0, 0.05) << what;
  EXPECT_TRUE(drive.scene.remarked(words)) << what;
  for (int i = 0; i < 10; ++i) {
    const RelativeMap next = drive.tick(drive.paint());
    EXPECT_EQ(next.fusion.source, Source::kFused) << what;
    EXPECT_NEAR(drive.error(next, 5.0), 0.0, 0.05) << what;
  }
}

TEST(StrayMessage, OfLocalizationDoesNotMoveTheLane) {
  for (const Stray& stray : kStrays) {
    StraightDrive drive = settled_drive();
    const Pose2 elsewhere(Point2(drive.x - 6.0, drive.y + 3.0), 0.3);
    const Time now = drive.scene.now();
    EXPECT_FALSE(drive.scene.pipeline().set_localization(localization_at(elsewhere, stamp_of(stray, now)),
                                                         std::nullopt, now))
        << stray.name;
    expect_undisturbed(drive, "localization: header.stamp is", stray.name);
  }
}

TEST(StrayMessage, OfTheChassisDoesNotMoveTheLane) {
  for (const Stray& stray : kStrays) {
    StraightDrive drive = settled_drive();
    const Time now = drive.scene.now();
    drive.scene.pipeline().set_chassis({stamp_of(stray, now), 40.0}, now);
    expect_undisturbed(drive, "chassis: header.stamp is", stray.name);
  }
}

TEST(StrayMessage, OfTheCameraDoesNotMoveTheLane) {
  for (const Stray& stray : kStrays) {
    StraightDrive drive = settled_drive();
    const Time now = drive.scene.now();
    LaneMarkers wrong = test::lane_about({1.2});
    wrong.stamp = stamp_of(stray, now);
    drive.scene.pipeline().set_lane_markers(wrong, now);
    expect_undisturbed(drive, "perception/lane_markers: header.stamp is", stray.name);
  }
}

TEST(StrayMessage, TimeHasGoneBackWhereSeveralSaySo) {
  Scene scene(three_straight_lines());
  for (int i = 0; i < 10; ++i) scene.at(Pose2(Point2(100.0 + i, 0.0), 0.0));
  const auto set = [&](int i) {
    return scene.pipeline().set_localization(
        localization_at(Pose2(Point2(50.0 + i, 0.0), 0.0), scene.now() + from_seconds(0.1 * i - 60.0)),
        std::nullopt, scene.now() + from_seconds(0.1 * i));
  };
  EXPECT_FALSE(set(0));
  EXPECT_FALSE(set(1));
  EXPECT_TRUE(set(2));
  EXPECT_TRUE(set(3));
}

TEST(StrayMessage, OnlyStampsOfTheFutureAreNoLocalization) {
  Scene scene(three_straight_lines());
  for (int i = 0; i < 5; ++i) {
    scene.wait(0.1);
    scene.pipeline().set_localization(
        localization_at(Pose2(Point2(100.0, 0.0), 0.0), scene.now() + from_seconds(0.7)), std::nullopt,
        scene.now());
    const RelativeMap map = scene.tick();
    EXPECT_EQ(map.status.code, StatusCode::kInvalidLocalization);
    EXPECT_THAT(map.status.message, HasSubstr("header.stamp is 0.7 s in the future"));
  }
}

TEST(Stamps, NeverGoBackAfterAnEmptyMap) {
  Scene scene(three_straight_lines());
  Time last = scene.tick().stamp;  // empty, of now
  for (int i = 0; i < 20; ++i) {
    scene.wait(0.1);
    const bool lost = i % 4 == 3;
    if (lost) scene.wait(1.0);
    const double age = 0.002 + 0.04 * (2 - i % 3);
    const Pose2 pose(Point2(100.0 + i, 0.0), 0.0);
    if (!lost) scene.pipeline().set_localization(localization_at(pose, scene.now() - from_seconds(age)));
    const RelativeMap map = scene.tick();
    EXPECT_GE(map.stamp, last) << i;
    EXPECT_EQ(map.status.code == StatusCode::kOk, !lost) << map.status.message;
    last = map.stamp;
  }
}

TEST(Stamps, TheMapIsThatOfItsStamp) {
  Scene scene(three_straight_lines());
  scene.tick();  // empty, of now
  scene.pipeline().set_localization(
      localization_at(Pose2(Point2(100.0, 0.0), 0.0), scene.now() - std::chrono::milliseconds(100), 20.0));
  const RelativeMap map = scene.tick();
  ASSERT_EQ(map.status.code, StatusCode::kOk) << map.status.message;
  EXPECT_EQ(map.stamp, scene.now());
  EXPECT_NEAR(map.lanes.at(1).remaining_distance, 500.0 - 2.0, 1e-6) << "2 m further on";
}

TEST(Stamps, GoBackWithTheClock) {
  Scene scene(three_straight_lines());
  scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  scene.wait(-30.0);
  const RelativeMap map = scene.at(Pose2(Point2(100.0, 0.0), 0.0));
  EXPECT_EQ(map.status.code, StatusCode::kNoLocalization) << "what was known is of another time";
  EXPECT_EQ(map.stamp, scene.now());
  EXPECT_EQ(scene.at(Pose2(Point2(101.0, 0.0), 0.0)).status.code, StatusCode::kOk);
}

}  // namespace
}  // namespace relative_map::core
