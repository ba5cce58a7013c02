// The three recorded lines, driven to their ends.
#include <gtest/gtest.h>

#include <cmath>

#include "reference_data.hpp"
#include "relative_map/io/navigation_line_file.hpp"
#include "relative_map/pipeline/contract/map_check.hpp"

namespace relative_map::core::test {
namespace {

NavigationInfo recorded_lines() {
  NavigationInfo info;
  info.frame_id = "map";
  for (const char* name : {"left", "middle", "right"}) {
    info.lines.push_back(
        read_navigation_line(reference_folder().value() + "/apollo_multi_lane/" + name + ".smoothed"));
    info.lines.back().priority = static_cast<std::uint32_t>(info.lines.size() - 1);
  }
  return info;
}

/// Drives along one of the lines and hands (s, map) of every half metre to `look`.
template <class Look>
void drive_along(std::size_t driven, Look look) {
  const NavigationInfo info = recorded_lines();
  RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>());
  pipeline.set_navigation_lines(prepare_navigation_lines(info, {}));
  const std::vector<LinePoint>& line = info.lines[driven].points;
  Time now = at_seconds(1000.0);
  double next_s = 0.0;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (line[i].s < next_s && i + 1 < line.size()) continue;
    next_s += 0.5;
    now += std::chrono::milliseconds(50);
    Localization localization;
    localization.stamp = now;
    localization.position = {line[i].x, line[i].y, 0.0};
    localization.heading = line[i].theta;
    localization.map_from_body = Eigen::AngleAxisd(line[i].theta, Eigen::Vector3d::UnitZ());
    pipeline.set_localization(localization);
    look(line[i].s, pipeline.tick(now));
  }
}

TEST(RecordedLines, KeepTheContractToTheEndOfEachLine) {
  REQUIRE_REFERENCE_DATA();
  for (const std::size_t driven : {0, 1, 2}) {
    std::size_t maps = 0;
    drive_along(driven, [&](double s, const RelativeMap& map) {
      ++maps;
      EXPECT_EQ(map.status.code, StatusCode::kOk) << "s = " << s << ": " << map.status.message;
      for (const Violation& violation : check_map(map, {})) {
        ADD_FAILURE() << "s = " << s << ", " << violation.row << ": " << violation.what;
      }
    });
    EXPECT_GT(maps, 1000u);
  }
}

TEST(RecordedLines, AreThreeLanesWhereverAllThreeAreInReach) {
  REQUIRE_REFERENCE_DATA();
  drive_along(1, [](double s, const RelativeMap& map) {
    if (s < 18.5 || s > 538.5) return;
    ASSERT_EQ(map.lanes.size(), 3u) << "s = " << s;
    EXPECT_EQ(map.lanes[0].id, "left");
    EXPECT_EQ(map.lanes[1].id, "middle");
    EXPECT_EQ(map.lanes[2].id, "right");
    EXPECT_EQ(map.current_lane_id, "middle") << "s = " << s;
    EXPECT_EQ(map.lanes[0].right_neighbor_id, "middle") << "s = " << s;
    EXPECT_EQ(map.lanes[1].right_neighbor_id, "right") << "s = " << s;
  });
}

TEST(RecordedLines, ReportTheDistanceThatIsLeft) {
  REQUIRE_REFERENCE_DATA();
  drive_along(1, [](double s, const RelativeMap& map) {
    for (const Lane& lane : map.lanes) {
      if (lane.id != "middle") continue;
      EXPECT_NEAR(lane.remaining_distance, 688.569 - s, 0.01) << "s = " << s;
    }
  });
}

}  // namespace
}  // namespace relative_map::core::test
