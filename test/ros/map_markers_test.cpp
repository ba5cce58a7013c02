#include "relative_map/ros/view/map_markers.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "ros/engine.hpp"

namespace relative_map {
namespace {

using test::Engine;
using test::kNaN;
using test::Point2;
using test::Pose2;
using test::shared;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const ros::Time kStamp(100.0);

/// Three lanes, the car on the middle one of them, and the paint that its camera sees.
MapMsg map_with(const LaneMarkers& markers, const core::PipelineConfig& config = core::PipelineConfig()) {
  NodeConfig node;
  node.pipeline = config;
  Engine engine(node);
  engine.mount("base_link", "camera_link", Eigen::Isometry3d::Identity());
  engine.set_lines(test::three_lanes(Pose2()));
  engine.drive_to(Pose2(Point2(20.0, 0.0), 0.0), kStamp);
  engine->on_lane_markers(shared(markers), kStamp);
  return engine.map_at(kStamp);
}

MapMsg fused_map() {
  return map_with(test::lane_markers(kStamp));
}

MapMsg empty_map() {
  return Engine().map_at(kStamp);
}

MarkerArray draw(const MapMsg& map) {
  return MapMarkers().draw(map, core::Footprint());
}

std::vector<Marker> in_namespace(const MarkerArray& array, const std::string& ns) {
  std::vector<Marker> found;
  for (const Marker& marker : array.markers) {
    if (marker.ns == ns && marker.action == Marker::ADD) found.push_back(marker);
  }
  return found;
}

std::vector<std::string> namespaces(const MarkerArray& array) {
  std::set<std::string> names;
  for (const Marker& marker : array.markers) {
    if (marker.action == Marker::ADD) names.insert(marker.ns);
  }
  return {names.begin(), names.end()};
}

TEST(MapMarkers, StartByDeletingAllThatWasDrawnBefore) {
  for (const MapMsg& map : {fused_map(), empty_map()}) {
    const MarkerArray array = draw(map);
    ASSERT_FALSE(array.markers.empty());
    EXPECT_EQ(array.markers[0].action, Marker::DELETEALL);
    for (std::size_t i = 1; i < array.markers.size(); ++i) EXPECT_EQ(array.markers[i].action, Marker::ADD);
  }
}

TEST(MapMarkers, ShowEverythingOfAMap) {
  const MarkerArray array = draw(fused_map());
  EXPECT_THAT(namespaces(array), ElementsAre("boundaries", "boundary_rims", "centerline", "footprint",
                                             "lane_markers", "lanes", "status"));
  EXPECT_EQ(in_namespace(array, "lanes").size(), 3u);
  EXPECT_EQ(in_namespace(array, "lane_markers").size(), 2u);
  EXPECT_EQ(in_namespace(array, "centerline").size(), 1u);
}

TEST(MapMarkers, DrawEachOfTheFourBordersOnce) {
  // By side, from -2 for the rightmost: where its stretches of paint begin and end.
  std::map<long, std::map<double, double>> sides;
  for (const Marker& marker : in_namespace(draw(fused_map()), "boundaries")) {
    ASSERT_FALSE(marker.points.empty());
    const auto [first, last] = std::minmax_element(marker.points.begin(), marker.points.end(),
                                                   [](const auto& a, const auto& b) { return a.x < b.x; });
    std::map<double, double>& stretches = sides[std::lround(first->y / test::kLaneWidth - 0.5)];
    EXPECT_TRUE(stretches.insert({first->x, last->x}).second) << "drawn twice from x = " << first->x;
  }
  ASSERT_EQ(sides.size(), 4u);
  for (const auto& [side, stretches] : sides) {
    EXPECT_LE(side, 1);
    EXPECT_GE(side, -2);
    double end = -5.0;
    for (const auto& [from, to] : stretches) {
      EXPECT_GE(from, end - 0.1) << "side " << side << " is drawn twice";
      EXPECT_LE(from, end + 5.0) << "side " << side << " has a gap";
      end = to;
    }
    EXPECT_GT(end, 240.0);
  }
}

TEST(MapMarkers, ShowNothingButStatusAndFootprintOfAnEmptyMap) {
  EXPECT_THAT(namespaces(draw(empty_map())), ElementsAre("footprint", "status"));
}

TEST(MapMarkers, ShowNothingOfAnEmptyMapThatHasMarkersWithIt) {
  Engine engine;
  engine->on_lane_markers(shared(test::lane_markers(kStamp)), kStamp);
  const MapMsg map = engine.map_at(kStamp);
  ASSERT_EQ(map.status.code, MapStatus::NO_LOCALIZATION);
  EXPECT_THAT(namespaces(draw(map)), ElementsAre("footprint", "status"));
}

TEST(MapMarkers, SayWhyAMapIsEmpty) {
  const std::vector<Marker> status = in_namespace(draw(empty_map()), "status");
  ASSERT_EQ(status.size(), 1u);
  EXPECT_THAT(status[0].text, HasSubstr("no localization received yet"));
}

TEST(MapMarkers, AreFewAndHaveFewPoints) {
  const MarkerArray array = draw(fused_map());
  std::size_t points = 0;
  for (const Marker& marker : array.markers) points += marker.points.size();
  EXPECT_LE(array.markers.size(), 30u);
  EXPECT_LE(points, 10000u);  // of three lanes of 250 m
}

TEST(MapMarkers, AreNotMoreOfFinelyRecordedLines) {
  const auto points_drawn = [](double spacing) {
    Engine engine;
    NavigationInfo info;
    info.header.frame_id = "map";
    info.navigation_path = {test::navigation_path(core::test::straight(Pose2(), 300.0, spacing), "line", 0)};
    engine.set_lines(info);
    engine.drive_to(Pose2(Point2(10.0, 0.0), 0.0), kStamp);
    std::size_t points = 0;
    for (const Marker& marker : draw(engine.map_at(kStamp)).markers) points += marker.points.size();
    return points;
  };
  EXPECT_GT(points_drawn(1.0), 500u);
  EXPECT_LT(points_drawn(0.05), 1.2 * points_drawn(1.0));
}

TEST(MapMarkers, AreAllFiniteAndInAKnownFrame) {
  MapMsg map = map_with(test::lane_markers(kStamp, 0.0, "camera_link"));
  map.lane_marker.left_lane_marker.c2_curvature = kNaN;
  map.lane_marker.right_lane_marker.longitude_start = kNaN;
  for (const Marker& marker : draw(map).markers) {
    EXPECT_EQ(marker.header.frame_id, marker.ns == "lane_markers" ? "camera_link" : "base_link");
    EXPECT_EQ(marker.pose.orientation.w, 1.0);
    for (const geometry_msgs::Point& p : marker.points) {
      EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) << marker.ns;
    }
  }
}

TEST(MapMarkers, AreKeptApartByNamespaceAndId) {
  std::set<std::pair<std::string, int>> seen;
  for (const Marker& marker : draw(fused_map()).markers) {
    EXPECT_TRUE(seen.insert({marker.ns, marker.id}).second) << marker.ns << " " << marker.id;
  }
}

TEST(MapMarkers, ListsAndStripsHaveWholeShapesAndASize) {
  for (const Marker& marker : draw(fused_map()).markers) {
    if (marker.action != Marker::ADD) continue;
    EXPECT_GT(std::max(marker.scale.x, marker.scale.z), 0.0) << marker.ns;
    EXPECT_GT(marker.color.a, 0.0f) << marker.ns;
    const std::size_t corners =
        marker.type == Marker::LINE_LIST ? 2 : (marker.type == Marker::TRIANGLE_LIST ? 3 : 1);
    EXPECT_EQ(marker.points.size() % corners, 0u) << marker.ns;
  }
}

TEST(MapMarkers, FillsCoverTheirLanes) {
  const MapMsg map = fused_map();
  const std::vector<Marker> lanes = in_namespace(draw(map), "lanes");
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    double area = 0.0;
    const std::vector<geometry_msgs::Point>& p = lanes[i].points;
    for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
      area += 0.5 * std::abs((p[k + 1].x - p[k].x) * (p[k + 2].y - p[k].y) -
                             (p[k + 1].y - p[k].y) * (p[k + 2].x - p[k].x));
    }
    EXPECT_NEAR(area, test::kLaneWidth * map.hdmap.lane[i].length, 1.0);
  }
}

TEST(MapMarkers, PaintIsDrawnFromWhereItWasSeenToWhereItWasSeen) {
  LaneMarkers markers = test::lane_markers(kStamp);
  markers.left_lane_marker.longitude_start = 4.0;
  markers.left_lane_marker.view_range = 33.5;
  markers.right_lane_marker.view_range = 21.0;
  const std::vector<Marker> seen = in_namespace(draw(map_with(markers)), "lane_markers");
  ASSERT_EQ(seen.size(), 2u);
  EXPECT_EQ(seen[0].points.front().x, 4.0);
  EXPECT_LE(seen[0].points.back().x, 33.5);
  EXPECT_GT(seen[0].points.back().x, 32.0);
  EXPECT_EQ(seen[0].points.front().y, 1.75);
  EXPECT_LE(seen[1].points.back().x, 21.0);
  EXPECT_GT(seen[1].points.back().x, 19.5);
  EXPECT_EQ(seen[1].points.front().y, -1.75);
}

TEST(MapMarkers, PaintHasTheFrameAndTheTimeOfItsImage) {
  LaneMarkers markers = test::lane_markers(kStamp - ros::Duration(0.1), 0.0, "/camera_link");
  for (const Marker& marker : in_namespace(draw(map_with(markers)), "lane_markers")) {
    EXPECT_EQ(marker.header.frame_id, "camera_link");
    EXPECT_EQ(marker.header.stamp, markers.header.stamp);
  }
}

TEST(MapMarkers, PaintThatIsNotSeenIsNotDrawn) {
  LaneMarkers markers = test::lane_markers(kStamp);
  markers.left_lane_marker.quality = 0.0;
  markers.right_lane_marker.view_range = 0.0;
  EXPECT_THAT(in_namespace(draw(map_with(markers)), "lane_markers"), IsEmpty());
  markers.right_lane_marker.view_range = kNaN;
  markers.left_lane_marker.quality = kNaN;
  EXPECT_THAT(in_namespace(draw(map_with(markers)), "lane_markers"), IsEmpty());
}

TEST(MapMarkers, PaintThatIsNotUsedIsNotDrawn) {
  EXPECT_THAT(in_namespace(draw(map_with(test::lane_markers(kStamp - ros::Duration(2.0)))), "lane_markers"),
              IsEmpty())
      << "too old";
  EXPECT_THAT(in_namespace(draw(map_with(test::lane_markers(kStamp, test::kLaneWidth))), "lane_markers"),
              IsEmpty())
      << "another lane's";
}

TEST(MapMarkers, TheFootprintIsTheVehicles) {
  core::Footprint footprint;
  footprint.half_width = 1.1;
  footprint.front_overhang = 4.2;
  footprint.rear_overhang = 0.7;
  for (const Marker& marker : MapMarkers().draw(empty_map(), footprint).markers) {
    if (marker.ns != "footprint") continue;
    for (const geometry_msgs::Point& p : marker.points) {
      EXPECT_TRUE(p.x == 4.2 || p.x == -0.7) << p.x;
      EXPECT_EQ(std::abs(p.y), 1.1);
    }
    EXPECT_EQ(marker.points.size(), 5u);
  }
}

TEST(Centerline, IsTheCurrentLanes) {
  const MapMsg map = fused_map();
  const nav_msgs::Path path = centerline(map);
  ASSERT_EQ(map.current_lane_id, map.navigation_path[1].lane_id);
  const auto& points = map.navigation_path[1].navigation_path.path.path_point;
  EXPECT_EQ(path.header, map.header);
  ASSERT_EQ(path.poses.size(), points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    EXPECT_EQ(path.poses[i].pose.position.x, points[i].x);
    EXPECT_EQ(path.poses[i].pose.position.y, points[i].y);
    const geometry_msgs::Quaternion& q = path.poses[i].pose.orientation;
    EXPECT_NEAR(2.0 * std::atan2(q.z, q.w), points[i].theta, 1e-12);
    EXPECT_EQ(path.poses[i].header.frame_id, "base_link");
  }
}

TEST(Centerline, OfAnEmptyMapIsEmpty) {
  const nav_msgs::Path path = centerline(empty_map());
  EXPECT_THAT(path.poses, IsEmpty());
  EXPECT_EQ(path.header.frame_id, "base_link");
}

}  // namespace
}  // namespace relative_map
