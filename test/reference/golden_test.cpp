// What must agree with the original's outputs.
#include <gtest/gtest.h>

#include "reference_data.hpp"
#include "relative_map/pipeline/contract/map_check.hpp"

namespace relative_map::core::test {
namespace {

using nlohmann::json;

json golden_of(const std::string& name) {
  return read_json(reference_folder().value() + "/golden/" + name + ".golden.json");
}

void expect_contract(const RelativeMap& map) {
  for (const Violation& violation : check_map(map, {})) {
    ADD_FAILURE() << violation.row << ": " << violation.what;
  }
}

/// Points as the original has them: x, y, z, theta, kappa, s, dkappa, ddkappa.
void expect_same_path(const Lane& lane, const json& points) {
  ASSERT_EQ(lane.path.size(), points.size()) << lane.id;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PathPoint& point = lane.path[i];
    EXPECT_NEAR(point.position.x(), points[i][0], 1e-9) << lane.id << " point " << i;
    EXPECT_NEAR(point.position.y(), points[i][1], 1e-9) << lane.id << " point " << i;
    EXPECT_NEAR(angle_difference(point.theta, points[i][3]), 0.0, 1e-5) << lane.id << " point " << i;
    EXPECT_NEAR(point.kappa, points[i][4], 2e-4) << lane.id << " point " << i;
    EXPECT_NEAR(point.s, points[i][5], 1e-5) << lane.id << " point " << i;
  }
}

/// The original's path for a lane: both names end in the line's number. None: null.
json path_of(const json& frame, const Lane& lane) {
  for (const json& path : frame["navigation_path"]) {
    if (path["name"].get<std::string>().back() == lane.name.back()) return path["points"];
  }
  return nullptr;
}

TEST(Golden, OneRecordedLineAtWeightZeroAgreesInEveryPoint) {
  REQUIRE_REFERENCE_DATA();
  const json golden = golden_of("real_1lane_weight_0");
  ScenarioRun run("real_1lane_weight_0");
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const RelativeMap map = run.next();
    expect_contract(map);
    ASSERT_EQ(map.lanes.size(), 1u);
    expect_same_path(map.lanes[0], path_of(golden["frames"][i], map.lanes[0]));
  }
}

TEST(Golden, ThreeLanesAgreeWhereTheyAreNotFused) {
  REQUIRE_REFERENCE_DATA();
  const json frame = golden_of("real_3lane")["frames"][0];
  const RelativeMap map = ScenarioRun("real_3lane").next();
  expect_contract(map);
  ASSERT_EQ(map.lanes.size(), 3u);
  EXPECT_NEAR(map.lanes[0].path[0].position.x(), -1.289263, 1e-6);
  EXPECT_NEAR(map.lanes[0].path[0].position.y(), 3.067567, 1e-6);
  EXPECT_NEAR(map.lanes[2].path[0].position.x(), -1.337752, 1e-6);
  EXPECT_NEAR(map.lanes[2].path[0].position.y(), -3.190664, 1e-6);
  expect_same_path(map.lanes[0], path_of(frame, map.lanes[0]));
  expect_same_path(map.lanes[2], path_of(frame, map.lanes[2]));
}

TEST(Golden, TheMiddleLaneIsNotPulledByMarkersThatDoNotExist) {
  REQUIRE_REFERENCE_DATA();
  const RelativeMap three = ScenarioRun("real_3lane").next();
  const RelativeMap alone = ScenarioRun("real_1lane_weight_0").next();
  ASSERT_EQ(three.lanes.size(), 3u);
  ASSERT_EQ(alone.lanes.size(), 1u);
  ASSERT_EQ(three.lanes[1].path.size(), alone.lanes[0].path.size());
  for (std::size_t i = 0; i < alone.lanes[0].path.size(); ++i) {
    EXPECT_EQ(three.lanes[1].path[i].position, alone.lanes[0].path[i].position);
  }
}

TEST(Golden, ADriveAgreesInTheLanesThatAreNotFused) {
  REQUIRE_REFERENCE_DATA();
  const json golden = golden_of("real_drive_200");
  ScenarioRun run("real_drive_200");
  std::size_t compared = 0;
  std::size_t next_golden = 0;
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const RelativeMap map = run.next();
    expect_contract(map);
    const json& frame = golden["frames"][next_golden];
    if (frame["frame"] != i) continue;
    ++next_golden;
    for (const Lane& lane : map.lanes) {
      if (lane.name == "Navigation path 1") continue;  // the original's is pulled to y = 0
      // Lines that begin ahead come into reach a little earlier here or there.
      const json points = path_of(frame, lane);
      if (points.is_null()) continue;
      expect_same_path(lane, points);
      ++compared;
    }
  }
  EXPECT_EQ(next_golden, golden["frames"].size());
  EXPECT_GE(compared, 2u * 19u) << "two lanes in all frames but the first two";
}

TEST(Golden, PathsFromMarkersAgreeInsideTheirViewRange) {
  REQUIRE_REFERENCE_DATA();
  const json golden = golden_of("perception_speeds");
  ScenarioRun run("perception_speeds");
  constexpr double kViewRange = 80.0;
  for (std::size_t i = 0; i < run.frames(); ++i) {
    const RelativeMap map = run.next();
    expect_contract(map);
    ASSERT_EQ(map.lanes.size(), 1u);
    const json points = golden["frames"][i]["navigation_path"].front()["points"];
    std::size_t compared = 0;
    for (std::size_t k = 0; k < points.size() && points[k][0] <= kViewRange; ++k) {
      const PathPoint& point = map.lanes[0].path.at(k);
      EXPECT_NEAR(point.position.x(), points[k][0], 1e-9);
      EXPECT_NEAR(point.position.y(), points[k][1], 1e-9);
      EXPECT_NEAR(point.theta, points[k][3], 1e-9);
      EXPECT_NEAR(point.kappa, points[k][4], 1e-9);
      ++compared;
    }
    EXPECT_EQ(compared, 83u) << "x from -2 to 80";
  }
}

}  // namespace
}  // namespace relative_map::core::test
