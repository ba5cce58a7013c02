// What the markers look like: colours, paint styles, the raw line, the status text.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "relative_map/ros/setup/raw_line.hpp"
#include "relative_map/ros/view/map_markers.hpp"
#include "ros/engine.hpp"

namespace relative_map {
namespace {

using test::Engine;
using test::kNaN;
using test::Point2;
using test::Pose2;
using test::shared;
using testing::HasSubstr;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

const ros::Time kStamp(100.0);

/// Three lanes and their markers; `x` [m] is how far along the car is.
class Scene {
 public:
  explicit Scene(double x = 20.0, const NodeConfig& config = NodeConfig()) : engine_(config) {
    engine_.set_lines(test::three_lanes(Pose2()));
    engine_.drive_to(Pose2(Point2(x, 0.0), 0.0), kStamp);
  }
  Engine& engine() { return engine_; }
  MapMsg map(double aside = 0.0) {
    engine_->on_lane_markers(shared(test::lane_markers(kStamp, aside)), kStamp);
    return engine_.map_at(kStamp);
  }

 private:
  Engine engine_;
};

MarkerArray draw(const MapMsg& map, const core::Polyline& raw_line = {}) {
  return MapMarkers().draw(map, core::Footprint(), raw_line);
}

std::vector<Marker> in_namespace(const MarkerArray& array, const std::string& ns) {
  std::vector<Marker> found;
  for (const Marker& marker : array.markers) {
    if (marker.ns == ns && marker.action == Marker::ADD) found.push_back(marker);
  }
  return found;
}

/// The boundaries that are drawn of a map whose leftmost border is of this type all along.
std::vector<Marker> painted(uint8_t type, bool is_virtual = false, double x = 20.0) {
  MapMsg map = Scene(x).map();
  map.hdmap.lane[0].left_boundary.boundary_type.resize(1);
  map.hdmap.lane[0].left_boundary.boundary_type[0].types = {type};
  map.hdmap.lane[0].left_boundary.is_virtual = is_virtual;
  std::vector<Marker> found = in_namespace(draw(map), "boundaries");
  const auto elsewhere = [](const Marker& marker) { return marker.points[0].y < 1.2 * test::kLaneWidth; };
  found.erase(std::remove_if(found.begin(), found.end(), elsewhere), found.end());
  return found;
}

double drawn_length(const Marker& marker) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < marker.points.size(); i += 2) {
    sum +=
        std::hypot(marker.points[i + 1].x - marker.points[i].x, marker.points[i + 1].y - marker.points[i].y);
  }
  return sum;
}

/// Relative luminance, as WCAG defines it for contrasts.
double luminance(const std_msgs::ColorRGBA& c) {
  const auto linear = [](double v) { return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4); };
  return 0.2126 * linear(c.r) + 0.7152 * linear(c.g) + 0.0722 * linear(c.b);
}

double contrast(double a, double b) {
  return (std::max(a, b) + 0.05) / (std::min(a, b) + 0.05);
}

TEST(MapMarkerStyles, LanesHaveTheColorOfTheirPriorityAndTheCurrentOneIsStrongest) {
  MapMsg map = Scene().map();
  const std::vector<Marker> lanes = in_namespace(draw(map), "lanes");
  ASSERT_EQ(lanes.size(), 3u);
  ASSERT_EQ(map.current_lane_id, map.hdmap.lane[1].id);
  std::set<std::tuple<float, float, float>> hues;
  for (const Marker& lane : lanes) hues.insert({lane.color.r, lane.color.g, lane.color.b});
  EXPECT_EQ(hues.size(), 3u);
  EXPECT_GT(lanes[1].color.a, 2.0f * lanes[0].color.a);
  EXPECT_EQ(lanes[0].color.a, lanes[2].color.a);

  map.current_lane_id = map.hdmap.lane[0].id;
  const std::vector<Marker> after = in_namespace(draw(map), "lanes");
  EXPECT_GT(after[0].color.a, 2.0f * after[1].color.a);
  EXPECT_EQ(after[0].color.r, lanes[0].color.r);
}

TEST(MapMarkerStyles, EveryCornerOfALaneHasItsColor) {
  for (const Marker& lane : in_namespace(draw(Scene().map()), "lanes")) {
    ASSERT_EQ(lane.colors.size(), lane.points.size());
    EXPECT_EQ(lane.colors.front(), lane.color);
    EXPECT_EQ(lane.colors.back(), lane.color);
  }
}

TEST(MapMarkerStyles, SolidPaintIsDrawnAllAlong) {
  for (const uint8_t type :
       {LaneBoundaryType::SOLID_WHITE, LaneBoundaryType::SOLID_YELLOW, LaneBoundaryType::CURB}) {
    const std::vector<Marker> drawn = painted(type);
    ASSERT_EQ(drawn.size(), 1u);
    EXPECT_NEAR(drawn_length(drawn[0]), Scene().map().hdmap.lane[0].left_boundary.length, 0.01);
  }
}

TEST(MapMarkerStyles, DottedPaintHasGapsAsLongAsItsDashes) {
  for (const uint8_t type : {LaneBoundaryType::DOTTED_WHITE, LaneBoundaryType::DOTTED_YELLOW}) {
    const std::vector<Marker> drawn = painted(type);
    ASSERT_EQ(drawn.size(), 1u);
    EXPECT_NEAR(drawn_length(drawn[0]), 0.5 * Scene().map().hdmap.lane[0].left_boundary.length, 3.0);
  }
}

TEST(MapMarkerStyles, WhiteYellowAndCurbAreToldApart) {
  const auto white = painted(LaneBoundaryType::DOTTED_WHITE)[0].color;
  const auto yellow = painted(LaneBoundaryType::DOTTED_YELLOW)[0].color;
  const auto curb = painted(LaneBoundaryType::CURB)[0].color;
  EXPECT_EQ(white, painted(LaneBoundaryType::SOLID_WHITE)[0].color);
  EXPECT_EQ(yellow, painted(LaneBoundaryType::SOLID_YELLOW)[0].color);
  EXPECT_GT(white.b, 0.9f);
  EXPECT_LT(yellow.b, 0.4f);
  EXPECT_GT(contrast(luminance(yellow), luminance(curb)), 2.0);  // the same to some eyes but for this
}

TEST(MapMarkerStyles, DoubleYellowIsTwoLines) {
  const std::vector<Marker> drawn = painted(LaneBoundaryType::DOUBLE_YELLOW);
  ASSERT_EQ(drawn.size(), 1u);
  std::set<long> sides;  // [mm]
  for (const auto& point : drawn[0].points) sides.insert(std::lround(1000.0 * point.y));
  const double middle = 1500.0 * test::kLaneWidth;
  ASSERT_EQ(sides.size(), 2u);
  EXPECT_NEAR(0.5 * static_cast<double>(*sides.begin() + *sides.rbegin()), middle, 1.0);
  EXPECT_GT(static_cast<double>(*sides.rbegin() - *sides.begin()), 1000.0 * drawn[0].scale.x);
}

TEST(MapMarkerStyles, BordersWithoutPaintAreThinAndVirtualOnesFaint) {
  const auto painted_one = painted(LaneBoundaryType::SOLID_WHITE)[0];
  const auto unknown = painted(LaneBoundaryType::UNKNOWN)[0];
  EXPECT_LT(unknown.scale.x, 0.5 * painted_one.scale.x);
  EXPECT_LT(painted(LaneBoundaryType::UNKNOWN, true)[0].color.a, 0.6f * unknown.color.a);
}

TEST(MapMarkerStyles, PaintHasADarkRimForLightBackgrounds) {
  const MarkerArray array = draw(Scene().map());
  const std::vector<Marker> rims = in_namespace(array, "boundary_rims");
  ASSERT_EQ(rims.size(), 1u);
  double paint = 0.0;
  for (const Marker& marker : in_namespace(array, "boundaries")) {
    if (marker.color.r < 0.9f) continue;  // no paint
    paint += drawn_length(marker);
    EXPECT_LT(rims[0].points[0].z, marker.points[0].z);
    EXPECT_GT(rims[0].scale.x, marker.scale.x);
  }
  EXPECT_GT(paint, 80.0);
  EXPECT_NEAR(drawn_length(rims[0]), paint, 0.01);
  EXPECT_GT(contrast(luminance(rims[0].color), 1.0), 7.0);
}

/// The dashes would run along with the car.
TEST(MapMarkerStyles, DashesStandStillOnTheRoad) {
  const auto first_end = [](double x) {  // on the road, of the first whole dash
    const std::vector<Marker> drawn = painted(LaneBoundaryType::DOTTED_WHITE, false, x);
    double end = drawn.at(0).points.at(1).x;
    for (std::size_t i = 2; i + 1 < drawn[0].points.size() && drawn[0].points[i].x < end + 1e-6; i += 2) {
      end = drawn[0].points[i + 1].x;
    }
    return x + end;
  };
  const double place = std::fmod(first_end(20.0), 6.0);
  for (const double x : {20.4, 21.3, 22.9, 24.2, 57.7}) {
    EXPECT_NEAR(std::remainder(first_end(x) - place, 6.0), 0.0, 1e-6) << x;
  }
}

TEST(MapMarkerStyles, TheStatusIsRedWithoutAMapAndReadOnAnyBackground) {
  const Marker good = in_namespace(draw(Scene().map()), "status").at(0);
  const Marker bad = in_namespace(draw(Engine().map_at(kStamp)), "status").at(0);
  EXPECT_THAT(good.text, HasSubstr("3 lanes, line + markers"));
  EXPECT_THAT(bad.text, HasSubstr("NO MAP: "));
  EXPECT_GT(bad.color.r, 0.9f);
  EXPECT_LT(bad.color.g + bad.color.b, 0.4f);
  EXPECT_LT(good.color.r, 0.1f);
  const double dark = 0.0194;  // of rviz: 34; 38; 44
  for (const Marker& text : {good, bad}) {
    EXPECT_GT(contrast(luminance(text.color), 1.0), 3.0) << text.text;  // WCAG's least, of large text
    EXPECT_GT(contrast(luminance(text.color), dark), 3.0) << text.text;
  }
}

TEST(MapMarkerStyles, TheStatusIsOneLine) {
  MapMsg map = Engine().map_at(kStamp);
  map.status.message = "first\nsecond\tthird; ";
  for (int i = 0; i < 100; ++i) map.status.message += "\xC3\xA4\xC3\xA4 ";
  const std::string text = in_namespace(draw(map), "status").at(0).text;
  EXPECT_THAT(text, HasSubstr("NO MAP: first second third; "));
  EXPECT_LE(text.size(), 90u);
  EXPECT_EQ(text.substr(text.size() - 3), "...");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\xC3'), std::count(text.begin(), text.end(), '\xA4'))
      << "cut within a character";
}

TEST(MapMarkerStyles, MarkersAreBoundedHoweverManyLanesThereAre) {
  Engine engine;
  NavigationInfo info;
  info.header.frame_id = "map";
  for (int i = 0; i < 60; ++i) {
    const Pose2 start(Point2(0.0, 3.0 * (i - 30)), 0.0);
    info.navigation_path.push_back(
        test::navigation_path(core::test::straight(start, 400.0, 1.0), std::to_string(i), i));
  }
  engine.set_lines(info);
  engine.drive_to(Pose2(Point2(20.0, 0.0), 0.0), kStamp);
  engine->on_lane_markers(shared(test::lane_markers(kStamp)), kStamp);
  const MapMsg map = engine.map_at(kStamp);
  ASSERT_GT(map.hdmap.lane.size(), 5u);
  EXPECT_LE(draw(map).markers.size(), 60u);
}

TEST(RawLine, IsDrawnBesideTheFusedPath) {
  NodeConfig config;
  config.pipeline.navigation_lane.lane_marker_weight = 1.0;
  Scene scene(20.0, config);
  const MapMsg map = scene.map(0.4);
  ASSERT_NEAR(map.fusion.lateral_offset, 0.4, 0.05);
  RawLine raw(OrientationConvention::kFlu, [](auto&, auto&, auto&) { return Eigen::Isometry3d::Identity(); });
  const core::Polyline line = raw.beside(map, scene.engine()->navigation_lines(), 15.0);
  ASSERT_GT(line.size(), 200u);
  for (const Point2& point : line) EXPECT_NEAR(point.y(), 0.0, 1e-9);
  EXPECT_LT(line.front().x(), 0.0);
  EXPECT_NEAR(line.back().x(), map.hdmap.lane[1].length, 5.0);

  const std::vector<Marker> drawn = in_namespace(draw(map, line), "navigation_line");
  const std::vector<Marker> centerline = in_namespace(draw(map, line), "centerline");
  ASSERT_EQ(drawn.size(), 1u);
  EXPECT_NE(drawn[0].color, centerline.at(0).color);
  EXPECT_GT(drawn[0].points.size(), 100u);
  EXPECT_EQ(drawn[0].points.size() % 2, 0u);
  for (const auto& point : drawn[0].points) EXPECT_NEAR(point.y, 0.0, 1e-6);
}

TEST(RawLine, IsThereOnlyWithAMapOfLines) {
  const LinkTransforms none = [](auto&, auto&, auto&) { return std::nullopt; };
  RawLine raw(OrientationConvention::kFlu, none);
  Scene scene;
  const MapMsg map = scene.map();
  EXPECT_FALSE(raw.beside(map, scene.engine()->navigation_lines(), 15.0).empty());
  EXPECT_TRUE(raw.beside(map, nullptr, 15.0).empty());
  EXPECT_TRUE(raw.beside(Engine().map_at(kStamp), scene.engine()->navigation_lines(), 15.0).empty());
  MapMsg other = map;
  other.localization.child_frame_id = "imu_link";
  EXPECT_TRUE(raw.beside(other, scene.engine()->navigation_lines(), 15.0).empty()) << "no transform";
  other = map;
  other.localization.pose.position.x = kNaN;
  EXPECT_TRUE(raw.beside(other, scene.engine()->navigation_lines(), 15.0).empty());
}

TEST(RawLine, IsThatOfTheBodyFrameAtTheMapsTime) {
  // The IMU is 2 m ahead of the body frame, and turned by 90 degrees; the map is for 0.1 s after the pose.
  Eigen::Isometry3d link_from_base = Eigen::Isometry3d::Identity();
  link_from_base.linear() = test::yaw(-M_PI / 2).toRotationMatrix();
  link_from_base.translation() = link_from_base.linear() * Eigen::Vector3d(-2.0, 0.0, 0.0);
  RawLine raw(OrientationConvention::kFlu, [&](auto&, auto&, auto&) { return link_from_base; });
  Scene scene;
  MapMsg map = scene.map();
  map.localization.child_frame_id = "imu_link";
  map.localization.pose.position.y = 1.0;
  map.localization.pose.heading = M_PI / 2;
  map.localization.pose.orientation = test::quaternion(test::yaw(M_PI / 2));
  map.header.stamp = kStamp + ros::Duration(0.1);
  const core::Polyline line = raw.beside(map, scene.engine()->navigation_lines(), 15.0);
  ASSERT_FALSE(line.empty());
  for (const Point2& point : line) {
    EXPECT_NEAR(point.y(), -1.0, 1e-6);
    EXPECT_NEAR(std::remainder(point.x() + 20.0 - 2.0 + 1.0, 1.0), 0.0,
                1e-6);  // vertices lie on whole metres
  }
}

}  // namespace
}  // namespace relative_map
