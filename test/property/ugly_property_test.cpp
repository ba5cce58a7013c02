#include <gtest/gtest.h>

#include <map>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "ugly_drive.hpp"

// No input, however ugly, gets a map out that breaks the contract: map_check never has anything to replace.
namespace relative_map::core {
namespace {

constexpr std::uint64_t kDrives = 8000;
constexpr int kSteps = 12;

TEST(UglyInputs, NeverMakeAMapThatBreaksTheContract) {
  std::map<StatusCode, int> statuses;
  std::map<Source, int> sources;
  std::size_t several_lanes = 0, without_borders = 0;
  for (std::uint64_t seed = 1; seed <= kDrives; ++seed) {
    test::UglyDrive drive(seed);
    RelativeMapPipeline pipeline(std::make_shared<PipelineConfig>());
    MapContext context;
    Time last_tick{};
    for (int step = 0; step < kSteps; ++step) {
      drive.step(pipeline);
      if (goes_back(last_tick, drive.now())) context.previous_stamp.reset();
      last_tick = drive.now();
      const RelativeMap map = pipeline.tick(drive.now());
      for (const std::string& remark : pipeline.remarks()) {
        without_borders +=
            remark.find(": lane '") != std::string::npos || remark.find(" m in '") != std::string::npos;
      }
      for (const Violation& violation : check_map(map, context)) {
        ADD_FAILURE() << "seed " << seed << ", step " << step << ", source "
                      << static_cast<int>(map.fusion.source) << ": " << violation.row << ": "
                      << violation.what;
      }
      context.previous_sequence_num = map.sequence_num;
      context.previous_stamp = map.stamp;
      ++statuses[map.status.code];
      ++sources[map.fusion.source];
      several_lanes += map.lanes.size() > 1;
    }
  }
  // They have been everywhere.
  EXPECT_GT(statuses[StatusCode::kOk], 10000);
  for (const StatusCode code :
       {StatusCode::kStaleLocalization, StatusCode::kInvalidLocalization, StatusCode::kNoNavigationLine,
        StatusCode::kOffRoute, StatusCode::kLineEnd, StatusCode::kMarkersUnusable}) {
    EXPECT_GT(statuses[code], 100) << "status " << static_cast<int>(code);
  }
  for (const Source source : {Source::kFused, Source::kNavigationLine, Source::kLaneMarkers}) {
    EXPECT_GT(sources[source], 300) << "source " << static_cast<int>(source);
  }
  EXPECT_GT(several_lanes, 3000u);
  EXPECT_GT(without_borders, 100u) << "lanes that fold, which are left out or cut short";
}

}  // namespace
}  // namespace relative_map::core
