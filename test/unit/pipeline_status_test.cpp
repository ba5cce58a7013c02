#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "support/scene.hpp"

// Maps that are empty, with the reason; and what is done without.
namespace relative_map::core {
namespace {

using test::lane_about;
using test::localization_at;
using test::recording;
using test::Scene;
using test::straight;
using test::three_straight_lines;
using testing::HasSubstr;

const Pose2 kOnTheRoad(Point2(100.0, 0.0), 0.0);

void expect_empty(const RelativeMap& map, StatusCode code, const std::string& words) {
  EXPECT_EQ(map.status.code, code) << map.status.message;
  EXPECT_THAT(map.status.message, HasSubstr(words));
  EXPECT_TRUE(map.lanes.empty());
  EXPECT_TRUE(map.roads.empty());
  EXPECT_EQ(map.current_lane_id, "");
  EXPECT_EQ(map.frame_id, "base_link");
}

TEST(PipelineStatus, NoLocalizationYet) {
  Scene scene(three_straight_lines());
  const RelativeMap map = scene.tick();
  expect_empty(map, StatusCode::kNoLocalization, "no localization received yet");
  EXPECT_EQ(map.stamp, scene.now());
  EXPECT_FALSE(scene.pipeline().pose_stamp());
}

TEST(PipelineStatus, LocalizationThatHasStopped) {
  Scene scene(three_straight_lines());
  EXPECT_EQ(scene.at(kOnTheRoad).status.code, StatusCode::kOk);
  scene.wait(0.4);
  EXPECT_EQ(scene.tick().status.code, StatusCode::kOk);
  scene.wait(0.2);
  expect_empty(scene.tick(), StatusCode::kStaleLocalization, "0.6 s old");
  EXPECT_EQ(scene.at(kOnTheRoad).status.code, StatusCode::kOk) << "it is back";
}

TEST(PipelineStatus, LocalizationThatIsInvalid) {
  Scene scene(three_straight_lines());
  Localization localization = localization_at(kOnTheRoad, scene.now());
  localization.position.y() = test::kNaN;
  scene.pipeline().set_localization(localization);
  expect_empty(scene.tick(), StatusCode::kInvalidLocalization, "pose.position.y is nan");
}

TEST(PipelineStatus, NoLinesYet) {
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>());
  pipeline.set_localization(localization_at(kOnTheRoad, at_seconds(5.0)));
  expect_empty(pipeline.tick(at_seconds(5.0)), StatusCode::kNoNavigationLine, "received yet");
}

TEST(PipelineStatus, LinesThatAreAllUnusable) {
  Scene scene({recording({}, "broken")});
  expect_empty(scene.at(kOnTheRoad), StatusCode::kNoNavigationLine,
               "line 'broken' is left out: it has no points");
}

TEST(PipelineStatus, OffTheRoute) {
  Scene scene(three_straight_lines());
  expect_empty(scene.at(Pose2(Point2(100.0, 80.0), 0.0)), StatusCode::kOffRoute,
               "no navigation line is in reach");
  expect_empty(scene.at(Pose2(Point2(100.0, 0.0), kPi)), StatusCode::kOffRoute, "the other way");
  EXPECT_EQ(scene.at(kOnTheRoad).status.code, StatusCode::kOk);
}

TEST(PipelineStatus, PastTheEndOfTheLine) {
  Scene scene(three_straight_lines());
  expect_empty(scene.at(Pose2(Point2(603.0, 0.0), 0.0)), StatusCode::kLineEnd, "the end of the line");
}

TEST(PipelineStatus, ALineThatEndsBesideOthersDropsOutAlone) {
  std::vector<RecordedLine> lines = three_straight_lines();
  lines[0].points.resize(200);  // 99.5 m
  Scene scene(lines);
  EXPECT_EQ(scene.at(Pose2(Point2(99.0, 0.0), 0.0)).lanes.size(), 3u);
  EXPECT_EQ(scene.at(Pose2(Point2(100.0, 0.0), 0.0)).lanes.size(), 2u);
  EXPECT_TRUE(scene.remarked("line 'left': the vehicle is past its end"));
}

TEST(PipelineStatus, PerceptionWithoutUsableMarkers) {
  PipelineConfig config;
  config.navigation_lane.lane_source = LaneSource::kPerception;
  Scene scene(three_straight_lines(), config);
  expect_empty(scene.at(kOnTheRoad), StatusCode::kMarkersUnusable, "none received yet");
  LaneMarkers poor = lane_about({0.0});
  poor.left.quality = poor.right.quality = 0.3;
  scene.see(poor);
  expect_empty(scene.at(kOnTheRoad), StatusCode::kMarkersUnusable, "quality is 0.3");
}

TEST(PipelineStatus, ReasonsOfMarkersAreToldWhereThereIsNoLineEither) {
  Scene scene({});
  expect_empty(scene.at(kOnTheRoad), StatusCode::kNoNavigationLine, "lane markers: none received yet");
}

TEST(PipelineStatus, MarkersThatHaveStoppedAreDoneWithout) {
  PipelineConfig config;
  config.lane_fusion.method = "fixed_weight";
  Scene scene(three_straight_lines(), config);
  scene.see(lane_about({0.5}));
  EXPECT_EQ(scene.at(kOnTheRoad).fusion.source, Source::kFused);
  for (int i = 0; i < 6; ++i) scene.at(kOnTheRoad);
  const RelativeMap map = scene.at(kOnTheRoad);
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
  EXPECT_NEAR(map.lanes[1].path[10].position.y(), 0.0, 1e-9) << "not pulled by what was seen long ago";
  EXPECT_TRUE(scene.remarked("lane markers: they are 0.7 s old"));
}

TEST(PipelineStatus, MarkersFromBeforeAnyPoseAreDoneWithout) {
  Scene scene(three_straight_lines());
  scene.at(kOnTheRoad);
  LaneMarkers markers = lane_about({0.5});
  markers.stamp = scene.now() - std::chrono::milliseconds(450);
  scene.pipeline().set_lane_markers(markers);
  EXPECT_EQ(scene.tick().fusion.source, Source::kNavigationLine);
  EXPECT_TRUE(scene.remarked("no pose is known for their stamp"));
}

TEST(PipelineStatus, LocalizationThatComesLateIsDropped) {
  Scene scene(three_straight_lines());
  scene.at(kOnTheRoad);
  const auto set = [&](double seconds_ago) {
    return scene.pipeline().set_localization(
        localization_at(Pose2(Point2(90.0, 0.0), 0.0), scene.now() - from_seconds(seconds_ago)));
  };
  for (const double seconds_ago : {0.0, 0.2, 2.0}) {
    EXPECT_FALSE(set(seconds_ago));
    EXPECT_EQ(scene.pipeline().pose_stamp(), scene.now());
  }
}

TEST(PipelineStatus, MarkersWithNumbersThatAreNotFiniteAreDoneWithoutByName) {
  PipelineConfig config;
  config.navigation_lane.lane_source = LaneSource::kPerception;
  Scene scene({}, config);
  LaneMarkers markers = lane_about({0.0});
  markers.left.quality = markers.right.quality = std::numeric_limits<double>::infinity();
  scene.see(markers);
  expect_empty(scene.at(kOnTheRoad), StatusCode::kMarkersUnusable, "left_lane_marker.quality is inf");
}

TEST(PipelineStatus, AfterAResetOnlyTheLinesAreLeft) {
  Scene scene(three_straight_lines());
  scene.see(lane_about({0.5}));
  scene.at(kOnTheRoad);
  scene.pipeline().reset();
  expect_empty(scene.tick(), StatusCode::kNoLocalization, "no localization");
  const RelativeMap map = scene.at(kOnTheRoad);
  EXPECT_EQ(map.lanes.size(), 3u);
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
}

TEST(PipelineStatus, AfterAJumpTheMapIsThereAtOnce) {
  Scene scene(three_straight_lines(3000.0));
  for (const double x : {100.0, 2500.0, 10.0, 1400.0}) {
    const RelativeMap map = scene.at(Pose2(Point2(x, 0.3), 0.0));
    ASSERT_EQ(map.lanes.size(), 3u);
    EXPECT_NEAR(map.lanes[1].path.front().position.x(), -1.5, 0.3);
    EXPECT_NEAR(map.lanes[1].remaining_distance, 3000.0 - x, 1e-6);
  }
}

TEST(PipelineStatus, WithoutAChassisTheSpeedIsTheVelocitys) {
  PipelineConfig config;
  config.navigation_lane.lane_source = LaneSource::kPerception;
  Scene scene({}, config);
  scene.see(lane_about({0.0}));
  scene.wait(0.1);
  scene.pipeline().set_localization(localization_at(kOnTheRoad, scene.now(), 25.0));
  EXPECT_NEAR(scene.tick().lanes.at(0).length, 202.0, 1e-9) << "8 s at 25 m/s, and 2 m behind";
}

TEST(PipelineStatus, ASpeedThatThePosesContradictIsToldAndTheMapGoesOn) {
  Scene scene(three_straight_lines(3000.0));
  double x = 100.0;
  for (int i = 0; i < 80; ++i) {
    scene.see(lane_about({-0.4}));
    const RelativeMap map = scene.at(Pose2(Point2(x += 1.0, 0.0), 0.0), 36.0);  // km/h
    ASSERT_EQ(map.lanes.size(), 3u);
    EXPECT_LT(std::abs(map.lanes[1].path[3].position.y()), 0.5);
  }
  EXPECT_TRUE(
      scene.remarked("chassis: speed_mps is 36 m/s, but the poses show 10 m/s: the poses are believed"));
  for (int i = 0; i < 80; ++i) scene.at(Pose2(Point2(x += 1.0, 0.0), 0.0), 10.0);
  EXPECT_FALSE(scene.remarked("the poses are believed"));
}

}  // namespace
}  // namespace relative_map::core
