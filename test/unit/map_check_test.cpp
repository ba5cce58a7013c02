#include "relative_map/pipeline/contract/map_check.hpp"

#include <gmock/gmock.h>

#include <functional>

#include "relative_map/pipeline/relative_map_pipeline.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::kNaN;
using test::recording;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double kKappa = 0.005;

/// Three neighbouring lanes in a gentle left curve, with the vehicle in the middle one.
RelativeMap good_map() {
  const Polyline middle = arc(Pose2({-10.0, 0.0}, 0.0), kKappa, 100.0, 0.5);
  const Polyline left = arc(Pose2({-10.0, 3.4}, 0.0), kKappa / (1.0 - 3.4 * kKappa), 98.0, 0.5);
  const Polyline right = arc(Pose2({-10.0, -3.4}, 0.0), kKappa / (1.0 + 3.4 * kKappa), 102.0, 0.5);
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>());
  pipeline.set_navigation_lines(prepare_navigation_lines(
      {"map", {recording(left, "left", 1), recording(middle, "middle", 0), recording(right, "right", 2)}},
      {}));
  Localization localization;
  localization.stamp = at_seconds(100.0);
  pipeline.set_localization(localization);
  return pipeline.tick(at_seconds(100.0));
}

std::vector<std::string> broken_rows(const RelativeMap& map) {
  std::vector<std::string> rows;
  for (const Violation& violation : check_map(map, {"base_link", 0})) rows.push_back(violation.row);
  return rows;
}

TEST(MapCheck, AGoodMapBreaksNoRow) {
  const RelativeMap map = good_map();
  ASSERT_EQ(map.lanes.size(), 3u);
  ASSERT_FALSE(map.lanes[1].left_neighbor_id.empty());
  EXPECT_THAT(broken_rows(map), IsEmpty());
}

TEST(MapCheck, AnEmptyMapWithAReasonBreaksNoRow) {
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>());
  EXPECT_THAT(broken_rows(pipeline.tick(at_seconds(1.0))), IsEmpty());
}

struct Breakage {
  const char* row;
  const char* what;
  std::function<void(RelativeMap&)> apply;
};

void PrintTo(const Breakage& breakage, std::ostream* out) {
  *out << breakage.row << ": " << breakage.what;
}

class MapCheckRow : public testing::TestWithParam<Breakage> {};

TEST_P(MapCheckRow, IsTheOnlyOneBroken) {
  RelativeMap map = good_map();
  GetParam().apply(map);
  EXPECT_THAT(broken_rows(map), ElementsAre(GetParam().row));
}

const Breakage kBreakages[] = {
    {"header", "another frame", [](RelativeMap& map) { map.frame_id = "map"; }},
    {"header", "no stamp", [](RelativeMap& map) { map.stamp = Time(); }},
    {"header", "a number left out", [](RelativeMap& map) { map.sequence_num = 2; }},
    {"emptiness", "lanes in spite of a fault",
     [](RelativeMap& map) { map.status.code = StatusCode::kOffRoute; }},
    {"emptiness", "nothing, and all well",
     [](RelativeMap& map) {
       map.lanes.clear();
       map.roads.clear();
       map.current_lane_id.clear();
     }},
    {"lane_ids", "a current lane that is not there", [](RelativeMap& map) { map.current_lane_id = "other"; }},
    {"lane_ids", "an id twice",
     [](RelativeMap& map) {
       map.lanes[2].id = "left";
       map.roads[0].lane_ids[2] = "left";
     }},
    {"priority", "two best lanes", [](RelativeMap& map) { map.lanes[0].priority = 0; }},
    {"priority", "no best lane", [](RelativeMap& map) { map.lanes[1].priority = 3; }},
    {"finite", "a point", [](RelativeMap& map) { map.lanes[0].path[3].position.x() = kNaN; }},
    {"finite", "a boundary", [](RelativeMap& map) { map.lanes[0].left_boundary.points[3].y() = kNaN; }},
    {"finite", "the fusion state", [](RelativeMap& map) { map.fusion.marker_range = kNaN; }},
    {"centerline", "a single point", [](RelativeMap& map) { map.lanes[1].path.resize(1); }},
    {"arc_length", "s that is not the chord's", [](RelativeMap& map) { map.lanes[1].path[10].s += 0.005; }},
    {"arc_length", "length that is not the last s", [](RelativeMap& map) { map.lanes[1].length += 5e-4; }},
    {"heading", "another direction",
     [](RelativeMap& map) {
       for (PathPoint& point : map.lanes[1].path) point.theta += 0.02;
     }},
    {"curvature", "another curvature",
     [](RelativeMap& map) {
       for (PathPoint& point : map.lanes[1].path) point.kappa = -0.01;
     }},
    {"curvature_rate", "another rate",
     [](RelativeMap& map) {
       for (PathPoint& point : map.lanes[1].path) point.dkappa = 0.02;
     }},
    {"sides", "left and right swapped, samples too",
     [](RelativeMap& map) {
       std::swap(map.lanes[0].left_boundary, map.lanes[0].right_boundary);
       std::swap(map.lanes[0].left_samples, map.lanes[0].right_samples);
       map.lanes[0].right_neighbor_id.clear();
       map.lanes[1].left_neighbor_id.clear();
       map.roads[0].left_edge = map.lanes[0].left_boundary.points;
     }},
    {"samples", "a width that is not the distance",
     [](RelativeMap& map) { map.lanes[1].left_samples[5].width = 2.0; }},
    {"samples", "none at all", [](RelativeMap& map) { map.lanes[1].right_samples.clear(); }},
    {"samples", "none at the start", [](RelativeMap& map) { map.lanes[1].right_samples.front().s = 0.1; }},
    {"samples", "none at the end", [](RelativeMap& map) { map.lanes[1].right_samples.pop_back(); }},
    {"neighbors", "one-sided", [](RelativeMap& map) { map.lanes[0].right_neighbor_id.clear(); }},
    {"neighbors", "a stranger", [](RelativeMap& map) { map.lanes[0].left_neighbor_id = "other"; }},
    {"neighbors", "in a circle",
     [](RelativeMap& map) {
       map.lanes[0].left_neighbor_id = "right";
       map.lanes[2].right_neighbor_id = "left";
     }},
    {"road", "the same lane three times", [](RelativeMap& map) { map.roads[0].lane_ids.assign(3, "left"); }},
    {"road", "another edge", [](RelativeMap& map) { map.roads[0].right_edge[0].y() -= 0.1; }},
    {"road", "none", [](RelativeMap& map) { map.roads.clear(); }},
    {"attributes", "no speed limit", [](RelativeMap& map) { map.lanes[0].speed_limit = 0.0; }},
    {"attributes", "paint that starts late",
     [](RelativeMap& map) { map.lanes[0].left_boundary.paint[0].s = 1.0; }},
    {"attributes", "no paint", [](RelativeMap& map) { map.lanes[0].left_boundary.paint.clear(); }},
};

INSTANTIATE_TEST_SUITE_P(Contract, MapCheckRow, testing::ValuesIn(kBreakages));

TEST(MapCheck, NeighborsWithAGapBetweenTheirBoundariesBreakTheirRow) {
  RelativeMap map = good_map();
  // The right lane's border moves, and its samples with it: only the sharing is broken.
  Lane& right = map.lanes[2];
  for (std::size_t i = 0; i < right.left_boundary.points.size(); ++i)
    right.left_boundary.points[i].y() -= 0.1;
  PolylineWalker walker(right.left_boundary.points);
  std::size_t hint = 0;
  for (WidthSample& sample : right.left_samples) {
    sample.width = std::sqrt(walker.next(interpolate(right.path, sample.s, hint).position).squared_distance);
  }
  EXPECT_THAT(broken_rows(map), ElementsAre("neighbors"));
}

TEST(MapCheck, EveryRowHasATestThatBreaksIt) {
  for (const std::string& row : map_check_rows()) {
    EXPECT_TRUE(std::any_of(std::begin(kBreakages), std::end(kBreakages), [&](const Breakage& breakage) {
      return row == breakage.row;
    })) << row;
  }
}

TEST(BadLane, IsNamedWithItsPlace) {
  RelativeMap map = good_map();
  const MapContext context;
  EXPECT_FALSE(find_bad_lane(map, context));
  std::swap(map.lanes[1].left_boundary, map.lanes[1].right_boundary);
  std::swap(map.lanes[1].left_samples, map.lanes[1].right_samples);
  const auto swapped = find_bad_lane(map, context);
  ASSERT_TRUE(swapped);
  EXPECT_EQ(swapped->lane, 1u);
  EXPECT_EQ(swapped->s, 0.0);
  EXPECT_NE(swapped->what.find(map.lanes[1].id), std::string::npos) << swapped->what;

  map = good_map();
  map.lanes[2].right_samples[20].width += 0.3;
  const auto wrong_width = find_bad_lane(map, context);
  ASSERT_TRUE(wrong_width);
  EXPECT_EQ(wrong_width->lane, 2u);
  EXPECT_EQ(wrong_width->s, map.lanes[2].right_samples[20].s);
}

TEST(Checked, LeavesAGoodMapAsItIs) {
  const RelativeMap map = checked(good_map(), {"base_link", 0});
  EXPECT_EQ(map.status.code, StatusCode::kOk);
  EXPECT_EQ(map.lanes.size(), 3u);
}

TEST(Checked, EmptiesABadMapAndNamesRowAndNumber) {
  RelativeMap bad = good_map();
  bad.lanes[1].left_samples[5].width = 2.0;
  const RelativeMap map = checked(bad, {"base_link", 0});
  EXPECT_EQ(map.status.code, StatusCode::kContractViolation);
  EXPECT_THAT(map.status.message, HasSubstr("samples: lane 'middle': left: width is 2 m"));
  EXPECT_THAT(check_map(map, {"base_link", 0}), IsEmpty());
}

}  // namespace
}  // namespace relative_map::core
