// What only a message can get wrong: it says things twice.
#include "relative_map/ros/messages/message_check.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "ros/engine.hpp"

namespace relative_map {
namespace {

using test::Engine;
using test::Point2;
using test::Pose2;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

MapMsg good_map() {
  const ros::Time stamp(100.0);
  Engine engine;
  engine.set_lines(test::three_lanes(Pose2()));
  engine.drive_to(Pose2(Point2(20.0, 0.3), 0.0), stamp);
  return engine.map_at(stamp);
}

std::vector<std::string> broken_rows(const MapMsg& map) {
  std::vector<std::string> rows;
  for (const core::Violation& violation : check_message(map, {})) {
    EXPECT_FALSE(violation.what.empty());
    rows.push_back(violation.row);
  }
  return rows;
}

TEST(MessageCheck, AGoodMapBreaksNoRow) {
  ASSERT_EQ(good_map().hdmap.lane.size(), 3u);
  EXPECT_THAT(broken_rows(good_map()), IsEmpty());
}

struct Breakage {
  const char* row;
  const char* what;
  std::function<void(MapMsg&)> apply;
};

void PrintTo(const Breakage& breakage, std::ostream* out) {
  *out << breakage.row << ": " << breakage.what;
}

class MessageCheckRow : public testing::TestWithParam<Breakage> {};

TEST_P(MessageCheckRow, IsTheOnlyOneBroken) {
  MapMsg map = good_map();
  GetParam().apply(map);
  EXPECT_THAT(broken_rows(map), ElementsAre(GetParam().row));
}

std::vector<geometry_msgs::Point>& curve_of_lane_1(MapMsg& map) {
  return map.hdmap.lane[1].central_curve.segment[0].line_segment.point;
}

INSTANTIATE_TEST_SUITE_P(
    MessageCheck, MessageCheckRow,
    testing::Values(
        Breakage{"navigation_path", "a path of no lane",
                 [](MapMsg& map) {
                   map.navigation_path.push_back(map.navigation_path[0]);
                   map.navigation_path.back().lane_id = "nobody";
                 }},
        Breakage{"navigation_path", "a path twice",
                 [](MapMsg& map) { map.navigation_path.push_back(map.navigation_path[0]); }},
        Breakage{"central_curve", "a point moved", [](MapMsg& map) { curve_of_lane_1(map)[7].y += 0.01; }},
        Breakage{"central_curve", "a point too few", [](MapMsg& map) { curve_of_lane_1(map).pop_back(); }},
        Breakage{"central_curve", "a point too many",
                 [](MapMsg& map) { curve_of_lane_1(map).push_back(curve_of_lane_1(map).back()); }},
        Breakage{"central_curve", "not finite", [](MapMsg& map) { curve_of_lane_1(map)[7].x = test::kNaN; }},
        Breakage{"lane_type", "a bicycle lane", [](MapMsg& map) { map.hdmap.lane[2].type = Lane::BIKING; }}));

TEST(MessageCheck, RowsHaveNames) {
  EXPECT_THAT(message_check_rows(), ElementsAre("navigation_path", "central_curve", "lane_type"));
}

TEST(MessageCheck, ALaneWithoutItsPathBreaksTheContractToo) {
  MapMsg map = good_map();
  map.navigation_path.pop_back();
  EXPECT_THAT(broken_rows(map), Contains("navigation_path"));
  EXPECT_THAT(broken_rows(map), Contains("centerline"));
}

TEST(MessageCheck, AnyMessageCanBeChecked) {
  MapMsg scraps;
  scraps.hdmap.lane.resize(2);
  scraps.hdmap.road.resize(1);
  scraps.navigation_path.resize(3);
  EXPECT_FALSE(broken_rows(scraps).empty());
  EXPECT_FALSE(broken_rows(MapMsg()).empty());
}

}  // namespace
}  // namespace relative_map
