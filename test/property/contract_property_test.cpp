#include <gtest/gtest.h>

#include <map>

#include "random_scene.hpp"
#include "relative_map/pipeline/contract/map_check.hpp"

// Whatever comes in, what goes out keeps the contract.
namespace relative_map::core {
namespace {

using test::RandomDrive;
using test::SceneParam;

/// The seed is enough to see a failure again: --gtest_filter and a breakpoint on it.
template <class Look>
void drive(std::uint64_t seed, const SceneParam& param, int steps, Look look) {
  RandomDrive drive(seed, param);
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>(drive.config()));
  pipeline.set_navigation_lines(
      prepare_navigation_lines({"map", drive.lines()}, IntakeParam::of(drive.config())));
  for (int i = 0; i < steps; ++i) {
    drive.step(pipeline);
    look(pipeline.tick(drive.now()), i);
  }
}

std::string rows_of(const std::vector<Violation>& violations) {
  std::string rows;
  for (const Violation& violation : violations) rows += violation.row + ": " + violation.what + "\n";
  return rows;
}

TEST(Contract, HoldsForEveryMapOfThousandsOfRandomDrives) {
  std::map<StatusCode, int> statuses;
  std::map<Source, int> sources;
  std::size_t most_lanes = 0;
  for (std::uint64_t seed = 1; seed <= 3000; ++seed) {
    MapContext context;
    drive(seed, SceneParam(), 10, [&](const RelativeMap& map, int step) {
      const std::vector<Violation> violations = check_map(map, context);
      EXPECT_TRUE(violations.empty()) << "seed " << seed << ", step " << step << "\n" << rows_of(violations);
      context.previous_sequence_num = map.sequence_num;
      context.previous_stamp = map.stamp;
      ++statuses[map.status.code];
      ++sources[map.fusion.source];
      most_lanes = std::max(most_lanes, map.lanes.size());
    });
    ASSERT_FALSE(HasFailure()) << "the first one is enough";
  }
  // The drives have been everywhere.
  EXPECT_GT(statuses[StatusCode::kOk], 10000);
  for (const StatusCode code : {StatusCode::kStaleLocalization, StatusCode::kInvalidLocalization,
                                StatusCode::kOffRoute, StatusCode::kLineEnd, StatusCode::kMarkersUnusable}) {
    EXPECT_GT(statuses[code], 20) << "status " << static_cast<int>(code);
  }
  for (const Source source : {Source::kFused, Source::kNavigationLine, Source::kLaneMarkers}) {
    EXPECT_GT(sources[source], 200) << "source " << static_cast<int>(source);
  }
  EXPECT_GE(most_lanes, 5u);
}

void expect_true_widths(const Lane& lane, const std::vector<WidthSample>& samples, const Polyline& border) {
  std::size_t hint = 0;
  for (std::size_t i = 0; i < samples.size(); i += 3) {
    const Point2 position = interpolate(lane.path, samples[i].s, hint).position;
    EXPECT_NEAR(samples[i].width, test::distance_by_brute_force(border, position), 0.01)
        << lane.id << " at s = " << samples[i].s;
  }
}

/// [rad] between the leftmost and the rightmost heading of a lane. Round a bend a border of another part of
/// the lane may be nearer than the one beside: that is not meant.
double bend_of(const Lane& lane) {
  double turn = 0.0, least = 0.0, most = 0.0;
  for (std::size_t i = 1; i < lane.path.size(); ++i) {
    turn += angle_difference(lane.path[i].theta, lane.path[i - 1].theta);
    least = std::min(least, turn);
    most = std::max(most, turn);
  }
  return most - least;
}

TEST(Contract, WidthsAreTheDistancesThatBruteForceFinds) {
  SceneParam param;
  param.faults = false;
  std::size_t compared = 0;
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    drive(seed, param, 3, [&](const RelativeMap& map, int) {
      double sharpest = 0.0;
      for (const Lane& lane : map.lanes) sharpest = std::max(sharpest, bend_of(lane));
      if (sharpest > 0.5 * kPi) return;
      for (const Lane& lane : map.lanes) {
        ++compared;
        expect_true_widths(lane, lane.left_samples, lane.left_boundary.points);
        expect_true_widths(lane, lane.right_samples, lane.right_boundary.points);
        if (sharpest > 0.2 * kPi) continue;
        expect_true_widths(lane, lane.left_road_samples, map.roads[0].left_edge);
        expect_true_widths(lane, lane.right_road_samples, map.roads[0].right_edge);
      }
    });
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
  EXPECT_GT(compared, 500u);
}

TEST(Contract, BordersLieOnTheirSides) {
  SceneParam param;
  param.faults = false;
  for (std::uint64_t seed = 1001; seed <= 1300; ++seed) {
    drive(seed, param, 3, [&](const RelativeMap& map, int step) {
      for (const Lane& lane : map.lanes) {
        if (bend_of(lane) > 0.5 * kPi) continue;
        for (std::size_t i = 0; i < lane.path.size(); i += 5) {
          const PathPoint& vertex = lane.path[i];
          const auto side = [&](const Polyline& border) {
            return cross(vertex.direction,
                         test::nearest_by_brute_force(border, vertex.position).point - vertex.position);
          };
          EXPECT_GT(side(lane.left_boundary.points), 0.0)
              << lane.id << " at s = " << vertex.s << ", step " << step;
          EXPECT_LT(side(lane.right_boundary.points), 0.0)
              << lane.id << " at s = " << vertex.s << ", step " << step;
        }
      }
    });
    ASSERT_FALSE(HasFailure()) << "seed " << seed;
  }
}

TEST(Contract, TheSameDriveGivesTheSameMaps) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    std::vector<RelativeMap> first, second;
    drive(seed, SceneParam(), 5, [&](const RelativeMap& map, int) { first.push_back(map); });
    drive(seed, SceneParam(), 5, [&](const RelativeMap& map, int) { second.push_back(map); });
    for (std::size_t i = 0; i < first.size(); ++i) {
      ASSERT_EQ(first[i].lanes.size(), second[i].lanes.size());
      for (std::size_t k = 0; k < first[i].lanes.size(); ++k) {
        EXPECT_EQ(first[i].lanes[k].left_boundary.points, second[i].lanes[k].left_boundary.points);
        EXPECT_EQ(positions_of(first[i].lanes[k].path), positions_of(second[i].lanes[k].path));
      }
    }
  }
}

}  // namespace
}  // namespace relative_map::core
