// The route node without its topics: messages in, segments out.
#include "relative_map/ros/route/route_engine.hpp"

#include <gmock/gmock.h>

#include <boost/make_shared.hpp>
#include <cmath>
#include <limits>

#include "relative_map/ros/messages/route_conversions.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map {
namespace {

using testing::HasSubstr;

const double kNan = std::numeric_limits<double>::quiet_NaN();

class RouteEngineTest : public testing::Test {
 protected:
  RouteEngineTest()
      : engine_(RouteNodeConfig(), [this](const std::string& target, const std::string& source,
                                          const ros::Time&) {
          return target == source ? std::optional<Eigen::Isometry3d>(Eigen::Isometry3d::Identity()) : link_;
        }) {
    core::LaneGraph graph = core::test::grid(2, 4);
    graph.frame_id = "map";
    engine_.set_graph(core::test::prepared(graph));
    engine_.set_route(
        core::test::one_passage_roads({{"a0", 10.0, 100.0}, {"a1", 0.0, 100.0}, {"a2", 0.0, 90.0}}));
  }

  void localize(double x, double y, double heading, double time, const std::string& frame = "map",
                const std::string& link = "base_link") {
    auto message = boost::make_shared<LocalizationEstimate>();
    message->header.stamp = ros::Time(time);
    message->header.frame_id = frame;
    message->child_frame_id = link;
    message->pose.position.x = x;
    message->pose.position.y = y;
    message->pose.orientation.w = 1.0;
    message->pose.heading = heading;
    engine_.on_localization(message, ros::Time(time));
  }
  RouteSegmentsArray told(double time) {
    const RouteSegmentsArrayPtr message = engine_.tick(ros::Time(time));
    return message ? *message : RouteSegmentsArray();
  }

  std::optional<Eigen::Isometry3d> link_;
  RouteEngine engine_;
};

TEST_F(RouteEngineTest, TellsEachPoseOnce) {
  localize(50.0, 0.3, 0.0, 100.0);
  const RouteSegmentsArray first = told(100.02);
  EXPECT_EQ(first.status.code, RouteStatus::OK) << first.status.message;
  EXPECT_EQ(first.header.stamp, ros::Time(100.0));
  EXPECT_EQ(first.header.frame_id, "map");
  EXPECT_EQ(first.lane_id, "a0");
  EXPECT_EQ(first.route_id.size(), 16u);
  ASSERT_EQ(first.segments.size(), 1u);
  EXPECT_GT(first.segments[0].path.path_point.size(), 100u);
  EXPECT_NEAR(first.segments[0].s, 50.0, 1e-6);
  EXPECT_EQ(engine_.tick(ros::Time(100.05)), nullptr);
  localize(51.0, 0.3, 0.0, 100.1);
  EXPECT_EQ(told(100.12).sequence_num, first.sequence_num + 1);
}

TEST_F(RouteEngineTest, SaysWhyThereIsNothing) {
  EXPECT_EQ(told(99.0).status.code, RouteStatus::NO_LOCALIZATION);
  localize(50.0, 0.0, 0.0, 100.0);
  EXPECT_EQ(told(100.9).status.code, RouteStatus::STALE_LOCALIZATION);
  localize(50.0, 0.0, 0.0, 105.0);
  EXPECT_EQ(told(101.0).status.code, RouteStatus::NO_LOCALIZATION);
  localize(kNan, 0.0, 0.0, 110.0);
  EXPECT_THAT(told(110.0).status.message, HasSubstr("not finite"));
  localize(50.0, 0.0, 0.0, 111.0, "utm");
  const RouteSegmentsArray mismatch = told(111.0);
  EXPECT_EQ(mismatch.status.code, RouteStatus::FRAME_MISMATCH);
  EXPECT_THAT(mismatch.status.message, HasSubstr("'utm'"));
  EXPECT_TRUE(mismatch.segments.empty());
}

TEST_F(RouteEngineTest, ARecordingMayStartAgain) {
  localize(50.0, 0.0, 0.0, 100.0);
  EXPECT_EQ(told(100.0).status.code, RouteStatus::OK);
  EXPECT_EQ(told(20.0).status.code, RouteStatus::NO_LOCALIZATION);
  localize(50.0, 0.0, 0.0, 20.1);
  EXPECT_EQ(told(20.1).status.code, RouteStatus::OK);
}

TEST_F(RouteEngineTest, WithoutAHeadingTheOrientationCounts) {
  localize(50.0, 0.0, kNan, 100.0);
  EXPECT_EQ(told(100.0).status.code, RouteStatus::OK);
}

TEST_F(RouteEngineTest, ThePoseOfAnotherLinkIsCarriedToTheBase) {
  localize(50.0, 0.0, 0.0, 100.0, "map", "gps");
  EXPECT_THAT(told(100.0).status.message, HasSubstr("no transform from localization's child_frame_id 'gps'"));
  link_ = Eigen::Isometry3d::Identity();
  link_->translation() = Eigen::Vector3d(-2.0, 0.5, 0.0);  // of base_link, seen from the antenna
  localize(50.0, 0.0, 0.0, 100.1, "map", "gps");
  const RouteSegmentsArray message = told(100.1);
  EXPECT_NEAR(message.s, 48.0, 1e-9);
  EXPECT_NEAR(message.l, 0.5, 1e-9);
}

TEST_F(RouteEngineTest, FindsARouteFromWhereTheVehicleIs) {
  FindRoute::Request request;
  request.from_vehicle = true;
  RouteWaypoint goal;
  goal.lane_id = "b3";
  goal.s = 50.0;
  request.waypoint = {goal};
  EXPECT_THAT(engine_.find(request).why_not, HasSubstr("no localization"));
  localize(50.0, 0.2, 0.0, 100.0);
  const core::SearchResult found = engine_.find(request);
  ASSERT_TRUE(found.route) << found.why_not;
  EXPECT_EQ(found.route->waypoints[0].lane_id, "a0");
  EXPECT_NEAR(found.route->distance, 300.0, 1e-6);
  request.waypoint[0].lane_id.clear();
  request.waypoint[0].pose.x = 5000.0;
  EXPECT_THAT(engine_.find(request).why_not, HasSubstr("no lane within 10 m of waypoint 0"));
}

core::LaneChangeRequest to_right() {
  core::LaneChangeRequest request;
  request.to = core::LaneChangeGoal::kRight;
  return request;
}

TEST_F(RouteEngineTest, ALaneChangeIsToldUntilItIsDoneAndTheSameRouteAgainIsNoNews) {
  const core::Route asked = *engine_.map().route();
  EXPECT_THAT(engine_.change_lane(to_right(), ros::Time(99.0)).why_not, HasSubstr("nothing is known yet"));
  localize(50.0, 0.0, 0.0, 100.0);
  const std::string id = told(100.0).route_id;
  EXPECT_EQ(engine_.change_lane(to_right(), ros::Time(100.0)).lane_id, "b0");
  EXPECT_THAT(engine_.change_lane(to_right(), ros::Time(100.0)).why_not, HasSubstr("is on"));
  EXPECT_EQ(engine_.set_route(asked).code, core::RouteCode::kOk);  // its publisher says it again
  localize(51.0, 0.0, 0.0, 100.1);
  RouteSegmentsArray message = told(100.1);
  ASSERT_EQ(message.segments.size(), 2u);
  EXPECT_NE(message.route_id, id);
  EXPECT_EQ(message.segments[0].priority, 1u);
  EXPECT_EQ(message.segments[1].priority, 0u);
  EXPECT_EQ(message.segments[1].previous_action, RoutePassage::RIGHT);
  EXPECT_GT(message.segments[1].path.path_point.size(), 100u);
  for (int i = 0; i < 3; ++i) {
    localize(60.0 + i, -3.4, 0.0, 101.0 + 0.1 * i);
    told(101.0 + 0.1 * i);
  }
  EXPECT_EQ(engine_.lane_change().state, core::LaneChangeState::kDone);
  EXPECT_EQ(engine_.last().place->lane_id, "b0");
  core::LaneChangeRequest back;
  back.to = core::LaneChangeGoal::kBack;
  EXPECT_EQ(engine_.change_lane(back, ros::Time(102.0)).lane_id, "a0");
}

TEST_F(RouteEngineTest, ALaneChangeThatFailsLeavesTheWayBefore) {
  localize(50.0, 0.0, 0.0, 100.0);
  const std::string id = told(100.0).route_id;
  core::LaneChangeRequest back;
  back.to = core::LaneChangeGoal::kBack;
  EXPECT_THAT(engine_.change_lane(back, ros::Time(100.0)).why_not, HasSubstr("no lane change to take back"));
  engine_.change_lane(to_right(), ros::Time(100.0));
  localize(51.0, 0.0, 0.0, 100.1);
  EXPECT_NE(told(100.1).route_id, id);
  localize(52.0, 0.0, 0.0, 121.0);
  RouteSegmentsArray message = told(121.0);
  EXPECT_EQ(engine_.lane_change().state, core::LaneChangeState::kTimedOut);
  EXPECT_EQ(message.route_id, id);
  EXPECT_EQ(message.segments.size(), 1u);
  engine_.change_lane(to_right(), ros::Time(121.0));
  EXPECT_EQ(engine_.change_lane(back, ros::Time(121.1)).why_not, "");
  EXPECT_EQ(engine_.lane_change().state, core::LaneChangeState::kAbandoned);
  localize(53.0, 0.0, 0.0, 121.2);
  EXPECT_EQ(told(121.2).route_id, id);
  // Localization that stays away is no reason to be on for ever.
  engine_.change_lane(to_right(), ros::Time(121.2));
  told(150.0);
  EXPECT_EQ(engine_.lane_change().state, core::LaneChangeState::kTimedOut);
  localize(53.0, 0.0, 0.0, 150.0);
  told(150.1);
  engine_.change_lane(to_right(), ros::Time(150.1));
  engine_.clear_route();
  EXPECT_EQ(engine_.lane_change().message, "the route was cleared");
}

MapMsg map_of_two_lanes() {
  MapMsg map;
  map.header.frame_id = "base_link";
  map.header.stamp = ros::Time(100.0);
  map.current_lane_id = "right";
  for (const bool left : {true, false}) {
    Lane lane;
    lane.id = left ? "left" : "right";
    LaneNavigationPath path;
    path.lane_id = lane.id;
    path.navigation_path.path_priority = left ? 0 : 1;
    path.remaining_distance = 1000.0;
    CurveSegment segment;
    for (double x = -10.0; x <= 100.0; x += 5.0) {
      geometry_msgs::Point point;
      point.x = x;
      point.y = left ? 3.5 : 0.0;
      segment.line_segment.point.push_back(point);
      PathPoint path_point;
      path_point.x = x;
      path_point.y = point.y;
      path_point.s = x + 10.0;
      path.navigation_path.path.path_point.push_back(path_point);
    }
    lane.central_curve.segment = {segment};
    lane.speed_limit = 12.0;
    (left ? lane.right_neighbor_forward_lane_id : lane.left_neighbor_forward_lane_id) = {left ? "right"
                                                                                              : "left"};
    map.hdmap.lane.push_back(lane);
    map.navigation_path.push_back(path);
  }
  return map;
}

TEST_F(RouteEngineTest, OnARelativeMapTheBestLaneIsTheTarget) {
  EXPECT_EQ(engine_.check_map_age(ros::Time(99.0))->status.code, RouteStatus::NO_MAP);
  const RouteSegmentsArray message = *engine_.on_relative_map(map_of_two_lanes(), ros::Time(100.0));
  EXPECT_EQ(message.status.code, RouteStatus::OK) << message.status.message;
  EXPECT_EQ(message.header.frame_id, "base_link");
  EXPECT_EQ(message.header.stamp, ros::Time(100.0));
  ASSERT_EQ(message.segments.size(), 2u);
  EXPECT_EQ(message.segments[0].id, "right");
  EXPECT_EQ(message.segments[0].next_action, RoutePassage::LEFT);
  EXPECT_TRUE(message.segments[1].is_neighbor);
  EXPECT_EQ(message.segments[0].path.path_point.size(), 23u);
  EXPECT_NEAR(message.segments[0].s, 10.0, 1e-9);
  EXPECT_EQ(message.segments[0].speed_limit[3], 12.0);
  EXPECT_EQ(engine_.check_map_age(ros::Time(100.2)), nullptr);
  EXPECT_EQ(engine_.check_map_age(ros::Time(101.0))->status.code, RouteStatus::STALE_MAP);
  EXPECT_EQ(engine_.on_relative_map(MapMsg(), ros::Time(101.1))->status.code, RouteStatus::NO_MAP);
}

TEST(RouteEngineOnAMap, TheLaneThatWasAskedForIsPreferred) {
  RouteNodeConfig config;
  config.source = RouteSource::kRelativeMap;
  RouteEngine engine(config, [](const std::string&, const std::string&, const ros::Time&) {
    return std::optional<Eigen::Isometry3d>(Eigen::Isometry3d::Identity());
  });
  MapMsg map = map_of_two_lanes();
  map.navigation_path[0].navigation_path.path_priority = 1;
  map.navigation_path[1].navigation_path.path_priority = 0;
  EXPECT_EQ(engine.on_relative_map(map, ros::Time(100.0))->segments[0].priority, 0u);
  core::LaneChangeRequest request;
  EXPECT_THAT(engine.change_lane(to_right(), ros::Time(100.0)).why_not, HasSubstr("no lane to the right"));
  EXPECT_EQ(engine.change_lane(request, ros::Time(100.0)).lane_id, "left");
  RouteSegmentsArrayPtr message = engine.on_relative_map(map, ros::Time(100.1));
  EXPECT_EQ(message->segments[0].id, "right");
  EXPECT_EQ(message->segments[0].priority, 1u);
  EXPECT_EQ(message->segments[1].priority, 0u);
  map.current_lane_id = "left";
  for (Lane& lane : map.hdmap.lane) {
    for (geometry_msgs::Point& point : lane.central_curve.segment[0].line_segment.point) point.y -= 3.5;
  }
  for (NavigationPath* path :
       {&map.navigation_path[0].navigation_path, &map.navigation_path[1].navigation_path}) {
    for (PathPoint& point : path->path.path_point) point.y -= 3.5;
  }
  engine.on_relative_map(map, ros::Time(102.0));
  message = engine.on_relative_map(map, ros::Time(102.1));
  EXPECT_EQ(engine.lane_change().state, core::LaneChangeState::kDone);
  EXPECT_EQ(message->segments[0].id, "left");
  EXPECT_EQ(message->segments[0].next_action, RoutePassage::FORWARD);  // it stays there
  map.hdmap.lane.erase(map.hdmap.lane.begin());
  map.navigation_path.erase(map.navigation_path.begin());
  map.current_lane_id = "right";
  map.hdmap.lane[0].left_neighbor_forward_lane_id.clear();
  EXPECT_EQ(engine.on_relative_map(map, ros::Time(102.2))->status.code, RouteStatus::OK);
}

TEST(RouteMessages, AGraphAndARouteAreReadAsTheyWereWritten) {
  core::LaneGraph graph = core::test::grid(2, 2);
  graph.frame_id = "map";
  graph.lanes[0].turn = core::LaneTurn::kLeftTurn;
  graph.lanes[0].left_paint = {{0.0, core::BoundaryType::kCurb}, {5.0, core::BoundaryType::kDottedWhite}};
  const core::LaneGraph same = to_core(to_message(graph));
  ASSERT_EQ(same.lanes.size(), graph.lanes.size());
  EXPECT_EQ(same.frame_id, "map");
  EXPECT_EQ(same.lanes[0].centerline, graph.lanes[0].centerline);
  EXPECT_EQ(same.lanes[0].successors, graph.lanes[0].successors);
  EXPECT_EQ(same.lanes[0].right_neighbors, graph.lanes[0].right_neighbors);
  EXPECT_EQ(same.lanes[0].turn, core::LaneTurn::kLeftTurn);
  EXPECT_EQ(same.lanes[0].left_paint[1].type, core::BoundaryType::kDottedWhite);
  EXPECT_EQ(same.lanes[0].left_width[0].width, 1.75);
  core::Route route = core::test::one_passage_roads({{"a0", 10.0, 100.0}, {"a1", 0.0, 90.0}});
  route.roads[0].passages[0].change_lane = core::ChangeLane::kLeft;
  EXPECT_TRUE(core::same_way(to_core(to_message(route)), route));
}

TEST(RouteParameters, AllFaultsAreNamed) {
  try {
    make_route_config({{"rate", -1.0},
                       {"source", std::string("road")},
                       {"route/look_back", std::string("far")},
                       {"typo", 1},
                       {"reference_line/spacing", 99.0}});
    FAIL() << "it was taken";
  } catch (const std::runtime_error& fault) {
    for (const char* part : {"rate is -1", "source is 'road'", "route/look_back must be a number",
                             "typo is not a parameter", "reference_line/spacing is 99"}) {
      EXPECT_THAT(fault.what(), HasSubstr(part));
    }
  }
}

TEST(RouteParameters, TheShippedFileIsTheDefaults) {
  const RouteNodeConfig shipped = make_route_config(read_yaml(RELATIVE_MAP_SOURCE_DIR "/config/route.yaml"));
  const RouteNodeConfig defaults;
  EXPECT_EQ(shipped.source, defaults.source);
  EXPECT_EQ(shipped.rate, defaults.rate);
  EXPECT_EQ(shipped.route.look_ahead_fast, defaults.route.look_ahead_fast);
  EXPECT_EQ(shipped.route.max_heading, defaults.route.max_heading);
  EXPECT_EQ(shipped.reference_line.follow, defaults.reference_line.follow);
  EXPECT_EQ(shipped.reference_line.lateral_acceleration, defaults.reference_line.lateral_acceleration);
  EXPECT_EQ(shipped.search.lane_change, defaults.search.lane_change);
  EXPECT_EQ(shipped.search.min_turn_radius, defaults.search.min_turn_radius);
}

}  // namespace
}  // namespace relative_map
