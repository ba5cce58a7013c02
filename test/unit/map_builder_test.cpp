#include "relative_map/pipeline/lanes/map_builder.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "support/lanes.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::concentric_lane;
using test::distance_by_brute_force;
using test::straight_lane;

RelativeMap map_of(std::vector<LanePath> lanes, std::size_t current = 0, const SeenPaint& paint = SeenPaint(),
                   const PipelineConfig& config = PipelineConfig()) {
  LaneBorders borders = find_borders(lanes, config.navigation_lane.max_lane_half_width);
  return build_map(lanes, std::move(borders), current, paint, config);
}

std::vector<LanePath> three_lanes() {
  return {concentric_lane("left", 0.01, 3.4, 4), concentric_lane("middle", 0.01, 0.0, 2),
          concentric_lane("right", 0.01, -3.6, 3)};
}

void expect_true_distances(const Lane& lane, const std::vector<WidthSample>& samples,
                           const Polyline& border) {
  ASSERT_FALSE(samples.empty());
  EXPECT_EQ(samples.front().s, 0.0);
  EXPECT_EQ(samples.back().s, lane.length);
  std::size_t hint = 0;
  for (const WidthSample& sample : samples) {
    const Point2 position = interpolate(lane.path, sample.s, hint).position;
    EXPECT_NEAR(sample.width, distance_by_brute_force(border, position), 1e-9) << "at s = " << sample.s;
  }
}

TEST(MapBuilder, SamplesAreTrueDistancesToTheBoundaries) {
  const RelativeMap map = map_of(three_lanes(), 1);
  for (const Lane& lane : map.lanes) {
    EXPECT_GE(lane.left_samples.size(), 50u) << "one a metre or two";
    expect_true_distances(lane, lane.left_samples, lane.left_boundary.points);
    expect_true_distances(lane, lane.right_samples, lane.right_boundary.points);
  }
  EXPECT_NEAR(map.lanes[1].left_samples[25].width, 1.7, 1e-3);
  EXPECT_NEAR(map.lanes[1].right_samples[25].width, 1.8, 1e-3);
}

TEST(MapBuilder, SamplesLieAtVerticesOfTheCenterline) {
  for (const double spacing : {0.1, 0.4, 3.0, 25.0}) {
    const RelativeMap map = map_of({straight_lane("a", 0.0, 0, -2.0, 100.3, spacing)});
    const Lane& lane = map.lanes[0];
    std::size_t vertex = 0;
    for (std::size_t i = 0; i < lane.left_samples.size(); ++i) {
      while (vertex < lane.path.size() && lane.path[vertex].s != lane.left_samples[i].s) ++vertex;
      EXPECT_LT(vertex, lane.path.size()) << "a metre or a vertex after the last one";
      if (i > 0) {
        EXPECT_LE(lane.left_samples[i].s - lane.left_samples[i - 1].s, std::max(1.4, spacing + 1e-9));
      }
    }
  }
}

TEST(MapBuilder, RoadSamplesAreTrueDistancesToTheRoadsEdges) {
  const RelativeMap map = map_of(three_lanes(), 1);
  for (const Lane& lane : map.lanes) {
    expect_true_distances(lane, lane.left_road_samples, map.roads[0].left_edge);
    expect_true_distances(lane, lane.right_road_samples, map.roads[0].right_edge);
  }
  EXPECT_NEAR(map.lanes[2].left_road_samples[3].width, 3.6 + 3.4 + 1.75, 1e-2);
}

TEST(MapBuilder, NeighboursKnowEachOther) {
  const RelativeMap map = map_of(three_lanes(), 1);
  EXPECT_EQ(map.lanes[0].left_neighbor_id, "");
  EXPECT_EQ(map.lanes[0].right_neighbor_id, "middle");
  EXPECT_EQ(map.lanes[1].left_neighbor_id, "left");
  EXPECT_EQ(map.lanes[1].right_neighbor_id, "right");
  EXPECT_EQ(map.lanes[2].left_neighbor_id, "middle");
  EXPECT_EQ(map.lanes[2].right_neighbor_id, "");
  EXPECT_EQ(map.current_lane_id, "middle");
}

TEST(MapBuilder, LanesWithAGapBetweenThemAreNoNeighbours) {
  const RelativeMap map = map_of({straight_lane("left", 6.0), straight_lane("right", 0.0, 1)});
  EXPECT_EQ(map.lanes[0].right_neighbor_id, "");
  EXPECT_EQ(map.lanes[1].left_neighbor_id, "");
}

TEST(MapBuilder, TheRoadHasAllLanesAndTheOutermostBoundaries) {
  const RelativeMap map = map_of(three_lanes(), 1);
  ASSERT_EQ(map.roads.size(), 1u);
  EXPECT_EQ(map.roads[0].lane_ids, std::vector<std::string>({"left", "middle", "right"}));
  EXPECT_EQ(map.roads[0].left_edge, map.lanes[0].left_boundary.points);
  EXPECT_EQ(map.roads[0].right_edge, map.lanes[2].right_boundary.points);
}

TEST(MapBuilder, TheBestPriorityIsZeroAndTheOthersKeepTheirDistance) {
  const RelativeMap map = map_of(three_lanes(), 1);
  EXPECT_EQ(map.lanes[0].priority, 2u);
  EXPECT_EQ(map.lanes[1].priority, 0u);
  EXPECT_EQ(map.lanes[2].priority, 1u);
}

TEST(MapBuilder, LanesHaveTheirLengthsAndTheSpeedLimit) {
  PipelineConfig config;
  config.map_param.default_speed_limit = 12.5;
  std::vector<LanePath> lanes = three_lanes();
  lanes[0].remaining = 321.0;
  lanes[1].remaining = -1e-9;
  const RelativeMap map = map_of(lanes, 1, {}, config);
  for (const Lane& lane : map.lanes) {
    EXPECT_EQ(lane.length, lane.path.back().s);
    EXPECT_EQ(lane.speed_limit, 12.5);
    EXPECT_EQ(lane.left_boundary.length, chord_length(lane.left_boundary.points));
    EXPECT_EQ(lane.right_boundary.length, chord_length(lane.right_boundary.points));
  }
  EXPECT_EQ(map.lanes[0].remaining_distance, 321.0);
  EXPECT_EQ(map.lanes[1].remaining_distance, 0.0) << "never less than nothing";
  EXPECT_EQ(map.frame_id, "base_link");
}

TEST(MapBuilder, OnlyTheOutermostLeftBoundaryIsVirtualWhereAskedFor) {
  PipelineConfig config;
  config.generate_left_boundary = false;
  const RelativeMap without = map_of(three_lanes(), 1, {}, config), with = map_of(three_lanes(), 1);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(without.lanes[i].left_boundary.is_virtual, i == 0);
    EXPECT_FALSE(without.lanes[i].right_boundary.is_virtual);
    EXPECT_FALSE(with.lanes[i].left_boundary.is_virtual);
  }
}

std::vector<BoundaryType> types_of(const LaneBoundary& boundary) {
  std::vector<BoundaryType> types;
  for (const PaintSpan& span : boundary.paint) types.push_back(span.type);
  return types;
}

using Types = std::vector<BoundaryType>;
constexpr BoundaryType kUnknown = BoundaryType::kUnknown;
constexpr BoundaryType kWhite = BoundaryType::kSolidWhite;
constexpr BoundaryType kYellow = BoundaryType::kSolidYellow;

TEST(MapBuilder, PaintIsUnknownWhereNoneWasSeen) {
  const RelativeMap map = map_of(three_lanes(), 1);
  for (const Lane& lane : map.lanes) {
    EXPECT_EQ(types_of(lane.left_boundary), Types({kUnknown}));
    EXPECT_EQ(lane.left_boundary.paint[0].s, 0.0);
  }
}

TEST(MapBuilder, PaintIsOnTheBoundaryWhereItWasSeenAndNowhereElse) {
  // Seen from 10 to 40 m along the current lane; the boundaries of an arc are shorter or longer than it.
  const RelativeMap map = map_of(three_lanes(), 1, {kYellow, kWhite, kUnknown, kUnknown, 10.0, 40.0});
  const Lane& lane = map.lanes[1];
  EXPECT_EQ(types_of(lane.left_boundary), Types({kUnknown, kYellow, kUnknown}));
  EXPECT_EQ(types_of(lane.right_boundary), Types({kUnknown, kWhite, kUnknown}));
  EXPECT_EQ(lane.left_boundary.paint[0].s, 0.0);
  EXPECT_NEAR(lane.left_boundary.paint[1].s, 10.0 * (1.0 - 0.01 * 1.7), 0.02);
  EXPECT_NEAR(lane.left_boundary.paint[2].s, 40.0 * (1.0 - 0.01 * 1.7), 0.02);
  EXPECT_NEAR(lane.right_boundary.paint[2].s, 40.0 * (1.0 + 0.01 * 1.8), 0.02);
}

TEST(MapBuilder, PaintOnASharedBoundaryIsTheNeighboursToo) {
  const RelativeMap map = map_of(three_lanes(), 1, {kYellow, kWhite, kUnknown, kUnknown, 10.0, 40.0});
  EXPECT_EQ(types_of(map.lanes[0].right_boundary), Types({kUnknown, kYellow, kUnknown}));
  EXPECT_EQ(types_of(map.lanes[0].left_boundary), Types({kUnknown}));
  EXPECT_EQ(types_of(map.lanes[2].left_boundary), Types({kUnknown, kWhite, kUnknown}));
  EXPECT_EQ(types_of(map.lanes[2].right_boundary), Types({kUnknown}));
  EXPECT_NEAR(map.lanes[0].right_boundary.paint[1].s, map.lanes[1].left_boundary.paint[1].s, 0.5);
}

TEST(MapBuilder, PaintBesideAGapIsNotTheOtherLanes) {
  const RelativeMap map = map_of({straight_lane("left", 6.0), straight_lane("right", 0.0, 1)}, 1,
                                 {kYellow, kWhite, kUnknown, kUnknown, 0.0, 40.0});
  EXPECT_EQ(types_of(map.lanes[0].right_boundary), Types({kUnknown}));
}

TEST(MapBuilder, PaintThatStartsBehindTheLaneStartsWithIt) {
  const RelativeMap map =
      map_of({straight_lane("a", 0.0)}, 0, {kYellow, kWhite, kUnknown, kUnknown, -3.0, 500.0});
  EXPECT_EQ(types_of(map.lanes[0].left_boundary), Types({kYellow}));
  EXPECT_EQ(types_of(map.lanes[0].right_boundary), Types({kWhite}));
  const RelativeMap behind =
      map_of({straight_lane("a", 0.0)}, 0, {kYellow, kWhite, kUnknown, kUnknown, -3.0, -1.0});
  EXPECT_EQ(types_of(behind.lanes[0].left_boundary), Types({kUnknown}));
}

TEST(MapBuilder, PaintIsFoundRoundAHalfCircle) {
  // Its far end lies beside its start.
  const LanePath half = test::lane("a", arc(Pose2(Point2(-2.0, 0.0), 0.0), 0.1, 60.0, 0.4));
  const RelativeMap map = map_of({half}, 0, {kYellow, kUnknown, kUnknown, kUnknown, 0.0, 31.4});
  EXPECT_NEAR(map.lanes[0].left_boundary.paint.back().s, 31.4 * (1.0 - 0.1 * 1.75), 0.1);
  EXPECT_EQ(types_of(map.lanes[0].right_boundary), Types({kUnknown}));
}

TEST(MapBuilder, PaintBeyondTheNeighborsIsOnBothSidesOfTheirFarBorders) {
  const std::vector<LanePath> lanes = {straight_lane("a", 7.0), straight_lane("b", 3.5),
                                       straight_lane("c", 0.0), straight_lane("d", -3.5),
                                       straight_lane("e", -7.0)};
  SeenPaint paint;
  paint.next_left = BoundaryType::kSolidYellow;
  paint.next_right = BoundaryType::kCurb;
  paint.from = 2.0;
  paint.to = 40.0;
  const RelativeMap map = map_of(lanes, 2, paint);
  const auto has = [](const LaneBoundary& boundary, BoundaryType type) {
    return std::any_of(boundary.paint.begin(), boundary.paint.end(),
                       [type](const PaintSpan& span) { return span.type == type; });
  };
  EXPECT_TRUE(has(map.lanes[0].right_boundary, BoundaryType::kSolidYellow));
  EXPECT_TRUE(has(map.lanes[1].left_boundary, BoundaryType::kSolidYellow));
  EXPECT_TRUE(has(map.lanes[3].right_boundary, BoundaryType::kCurb));
  EXPECT_TRUE(has(map.lanes[4].left_boundary, BoundaryType::kCurb));
  EXPECT_FALSE(has(map.lanes[4].right_boundary, BoundaryType::kCurb));
}

}  // namespace
}  // namespace relative_map::core
