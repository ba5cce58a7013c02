// What the map engine makes of its inputs as time goes by.
#include "relative_map/ros/map/map_engine.hpp"

#include <gmock/gmock.h>

#include "ros/engine.hpp"

namespace relative_map {
namespace {

using test::Engine;
using test::kNaN;
using test::localization;
using test::Point2;
using test::Pose2;
using test::shared;
using testing::AllOf;
using testing::HasSubstr;
using testing::IsEmpty;

const ros::Time kStart(100.0);
const Pose2 kOnMiddleLane(Point2(20.0, 0.3), 0.0);

ros::Time after(double seconds) {
  return kStart + ros::Duration(seconds);
}

/// An engine that has three lines and has just made its first map.
class MapEngineOnItsWay : public testing::Test {
 protected:
  MapEngineOnItsWay() {
    engine.set_lines(test::three_lanes(Pose2()));
    engine.drive_to(kOnMiddleLane, kStart);
    first_ = engine.map_at(kStart);
  }
  void SetUp() override { ASSERT_EQ(first_.hdmap.lane.size(), 3u) << first_.status.message; }

  Engine engine;
  MapMsg first_;
};

TEST(MapEngine, SaysThatThereIsNoLocalizationAtEachTick) {
  Engine engine;
  for (int i = 0; i < 3; ++i) {
    const MapMsg map = engine.map_at(after(0.1 * i));
    EXPECT_EQ(map.status.code, MapStatus::NO_LOCALIZATION);
    EXPECT_EQ(map.header.stamp, after(0.1 * i));
    EXPECT_EQ(map.header.frame_id, "base_link");
    EXPECT_THAT(map.hdmap.lane, IsEmpty());
  }
}

TEST(MapEngine, SaysThatThereIsNoLine) {
  Engine engine;
  engine.drive_to(kOnMiddleLane, kStart);
  EXPECT_EQ(engine.map_at(kStart).status.code, MapStatus::NO_NAVIGATION_LINE);
}

TEST(MapEngine, SaysWhyLinesAreOfNoUse) {
  NavigationInfo lines = test::three_lanes(Pose2());
  lines.navigation_path[0].path.path_point.clear();
  lines.navigation_path[1].path.path_point.resize(1);
  lines.navigation_path[2].path.path_point[100].y = kNaN;
  Engine engine;
  engine.set_lines(lines);
  engine.drive_to(kOnMiddleLane, kStart);
  const MapMsg map = engine.map_at(kStart);
  EXPECT_EQ(map.status.code, MapStatus::NO_NAVIGATION_LINE);
  EXPECT_THAT(map.status.message, AllOf(HasSubstr("left"), HasSubstr("middle"), HasSubstr("right")));
}

TEST_F(MapEngineOnItsWay, StampsTheMapWithThePose) {
  EXPECT_EQ(first_.header.stamp, kStart);
  engine.drive_to(kOnMiddleLane, after(0.07));
  EXPECT_EQ(engine.map_at(after(0.1)).header.stamp, after(0.07));
}

TEST_F(MapEngineOnItsWay, CountsItsMapsOneByOne) {
  uint32_t last = first_.sequence_num;
  for (int i = 1; i < 20; ++i) {
    if (i % 3 != 0) engine.drive_to(kOnMiddleLane, after(0.1 * i));
    if (i == 10) engine->reset();
    if (i == 15) engine.set_lines(test::three_lanes(Pose2(Point2(0.0, 900.0), 0.0)));
    if (const MapMsgPtr map = engine->tick(after(0.1 * i))) {
      EXPECT_EQ(map->sequence_num, ++last);
    }
  }
  EXPECT_GT(last, first_.sequence_num + 10);
}

TEST_F(MapEngineOnItsWay, DoesNotMapAPoseTwice) {
  EXPECT_EQ(engine->tick(after(0.1)), nullptr);
  engine.drive_to(kOnMiddleLane, kStart);  // sent once more
  EXPECT_EQ(engine->tick(after(0.2)), nullptr);
  engine.drive_to(kOnMiddleLane, after(0.3));
  EXPECT_NE(engine->tick(after(0.3)), nullptr);
}

TEST_F(MapEngineOnItsWay, PassesThePoseOnThatTheMapIsForWhereALaterOneComesLate) {
  const Pose2 further(Point2(24.0, 0.1), 0.0);
  engine.drive_to(further, after(0.4));
  engine.drive_to(Pose2(Point2(23.0, 2.0), 0.0), after(0.3));  // overtaken on its way
  const MapMsg map = engine.map_at(after(0.4));
  EXPECT_EQ(map.header.stamp, after(0.4));
  EXPECT_EQ(map.localization, localization(further, after(0.4)));
  engine.drive_to(Pose2(Point2(23.5, 2.0), 0.0), after(0.35));
  EXPECT_EQ(engine->tick(after(0.5)), nullptr) << "no pose gets two maps";
}

TEST_F(MapEngineOnItsWay, PutsUpWithAnyMaximumAge) {
  core::PipelineConfig config = engine->config();
  config.max_age.localization = 1e12;  // [s] more than fits into a time
  engine->set_config(config);
  engine.drive_to(kOnMiddleLane, after(3600.0));
  EXPECT_EQ(engine.map_at(after(0.1)).status.code, MapStatus::OK);
}

TEST_F(MapEngineOnItsWay, EmptiesTheMapWhenThePoseIsStaleAndGoesOnSayingSo) {
  EXPECT_EQ(engine->tick(after(0.5)), nullptr);
  for (const double seconds : {0.6, 0.7, 0.8}) {
    const MapMsg map = engine.map_at(after(seconds));
    EXPECT_EQ(map.status.code, MapStatus::STALE_LOCALIZATION);
    EXPECT_EQ(map.header.stamp, after(seconds));
    EXPECT_THAT(map.hdmap.lane, IsEmpty());
  }
  engine.drive_to(kOnMiddleLane, after(0.9));
  EXPECT_EQ(engine.map_at(after(0.9)).status.code, MapStatus::OK);
}

TEST_F(MapEngineOnItsWay, DropsOnePoseOfTheFuture) {
  engine->on_localization(shared(localization(Pose2(), after(3600.0))), after(0.1));
  engine.drive_to(kOnMiddleLane, after(0.2));
  const MapMsg map = engine.map_at(after(0.2));
  EXPECT_EQ(map.status.code, MapStatus::OK);
  EXPECT_EQ(map.localization.header.stamp, after(0.2));
}

TEST_F(MapEngineOnItsWay, EmptiesTheMapWhenPosesAreOfTheFutureAndGoesOnSayingSo) {
  engine->reset();
  for (const double seconds : {0.1, 0.2, 0.3}) {
    engine->on_localization(shared(localization(kOnMiddleLane, after(3600.0 + seconds))), after(seconds));
    const MapMsg map = engine.map_at(after(seconds));
    EXPECT_EQ(map.status.code, MapStatus::INVALID_LOCALIZATION);
    EXPECT_THAT(map.status.message, HasSubstr("in the future"));
    EXPECT_EQ(map.header.stamp, after(seconds));
    EXPECT_THAT(map.hdmap.lane, IsEmpty());
  }
  engine.drive_to(kOnMiddleLane, after(0.4));
  EXPECT_EQ(engine.map_at(after(0.4)).status.code, MapStatus::OK);
}

TEST_F(MapEngineOnItsWay, PutsUpWithAClockThatIsALittleBehind) {
  engine.drive_to(kOnMiddleLane, after(0.2));
  const MapMsg map = engine.map_at(after(0.1));
  EXPECT_EQ(map.status.code, MapStatus::OK);
  EXPECT_EQ(map.header.stamp, after(0.2));
  EXPECT_EQ(engine->tick(after(0.15)), nullptr);
}

TEST_F(MapEngineOnItsWay, EmptiesTheMapWhenAPoseIsNotFinite) {
  LocalizationEstimate bad = localization(kOnMiddleLane, after(0.1));
  bad.pose.position.y = kNaN;
  engine->on_localization(shared(bad), after(0.1));
  const MapMsg map = engine.map_at(after(0.1));
  EXPECT_EQ(map.status.code, MapStatus::INVALID_LOCALIZATION);
  EXPECT_THAT(map.status.message, HasSubstr("position.y"));
  EXPECT_THAT(map.hdmap.lane, IsEmpty());
}

TEST_F(MapEngineOnItsWay, ForgetsAllButTheLinesWhenTheClockGoesBack) {
  engine->on_lane_markers(shared(test::lane_markers(kStart)), kStart);
  const ros::Time earlier(50.0);
  const MapMsg map = engine.map_at(earlier);
  EXPECT_EQ(map.status.code, MapStatus::NO_LOCALIZATION);
  EXPECT_EQ(map.localization, LocalizationEstimate());
  EXPECT_EQ(map.lane_marker, LaneMarkers());
  EXPECT_EQ(map.sequence_num, first_.sequence_num + 1);
  engine.drive_to(kOnMiddleLane, earlier + ros::Duration(0.1));
  EXPECT_EQ(engine.map_at(earlier + ros::Duration(0.1)).hdmap.lane.size(), 3u);
}

TEST_F(MapEngineOnItsWay, MapsTheSamePoseAgainAfterTheClockWentBack) {
  engine->tick(ros::Time(50.0));
  engine.drive_to(kOnMiddleLane, kStart);
  EXPECT_EQ(engine.map_at(kStart).status.code, MapStatus::OK);
}

TEST_F(MapEngineOnItsWay, ForgetsAllButTheLinesOnReset) {
  engine->on_lane_markers(shared(test::lane_markers(kStart)), kStart);
  engine->reset();
  const MapMsg map = engine.map_at(after(0.1));
  EXPECT_EQ(map.status.code, MapStatus::NO_LOCALIZATION);
  EXPECT_EQ(map.lane_marker, LaneMarkers());
  engine.drive_to(kOnMiddleLane, after(0.2));
  const MapMsg next = engine.map_at(after(0.2));
  EXPECT_EQ(next.hdmap.lane.size(), 3u);
  EXPECT_EQ(next.fusion.source, FusionState::NAVIGATION_LINE);
}

TEST_F(MapEngineOnItsWay, PassesMarkersAndLocalizationOnAsTheyCame) {
  LaneMarkers markers = test::lane_markers(after(0.1));
  markers.header.seq = 7;
  LocalizationEstimate pose = localization(kOnMiddleLane, after(0.1));
  pose.uncertainty.position_std_dev.x = 0.5;
  pose.pose.euler_angles.x = kNaN;  // not read
  engine->on_lane_markers(shared(markers), after(0.1));
  engine->on_localization(shared(pose), after(0.1));
  const MapMsg map = engine.map_at(after(0.1));
  EXPECT_EQ(map.status.code, MapStatus::OK);
  EXPECT_EQ(map.lane_marker, markers);
  EXPECT_EQ(map.localization.uncertainty, pose.uncertainty);
}

TEST_F(MapEngineOnItsWay, TakesANewConfigurationWithTheNextMap) {
  core::PipelineConfig config = engine->config();
  config.map_param.default_speed_limit = 13.0;
  config.navigation_lane.max_len_from_navigation_line = 50.0;
  engine->set_config(config);
  engine.drive_to(kOnMiddleLane, after(0.1));
  const MapMsg map = engine.map_at(after(0.1));
  EXPECT_EQ(map.hdmap.lane[0].speed_limit, 13.0);
  EXPECT_LT(map.hdmap.lane[0].length, 60.0);
}

TEST_F(MapEngineOnItsWay, EachMapIsAMessageOfItsOwn) {
  engine.drive_to(kOnMiddleLane, after(0.1));
  const MapMsgPtr map = engine->tick(after(0.1));
  ASSERT_NE(map, nullptr);
  const MapMsg copy = *map;
  engine.drive_to(Pose2(Point2(30.0, -3.0), 0.1), after(0.2));
  engine->on_lane_markers(shared(test::lane_markers(after(0.2))), after(0.2));
  EXPECT_NE(engine->tick(after(0.2)), map);
  EXPECT_EQ(*map, copy);
}

TEST_F(MapEngineOnItsWay, TheSameInputsGiveTheSameMap) {
  Engine other;
  other.set_lines(test::three_lanes(Pose2()));
  other.drive_to(kOnMiddleLane, kStart);
  EXPECT_EQ(other.map_at(kStart), first_);
}

}  // namespace
}  // namespace relative_map
