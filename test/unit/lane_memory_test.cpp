#include "relative_map/prediction/lane_memory.hpp"

#include <gmock/gmock.h>

#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

TrafficLanes window(double from, double y = 0.0, const std::string& id = "a") {
  TrafficLanes lanes;
  lanes.lanes = {straight_lane(id, y, from, from + 250.0)};
  return lanes;
}

TEST(LaneMemory, KeepsWhatWasPassed) {
  LaneMemory memory;
  memory.remember(window(0.0));
  for (double x = 1.0; x <= 90.0; x += 1.0) memory.remember(window(x));
  const Polyline line = memory.remember(window(91.0)).lanes[0].center;
  EXPECT_NEAR(line.front().x(), 0.0, 5.0);
  EXPECT_NEAR(line.back().x(), 341.0, 1e-9);
  for (std::size_t i = 1; i < line.size(); ++i) EXPECT_GT(line[i].x(), line[i - 1].x());
}

TEST(LaneMemory, ForgetsAfterSoManyMetresAndDoesNotGrow) {
  LaneMemory memory(150.0);
  std::size_t most = 0;
  for (double x = 0.0; x <= 2000.0; x += 1.0) {
    const Polyline line = memory.remember(window(x)).lanes[0].center;
    most = std::max(most, line.size());
    EXPECT_GE(line.front().x(), x - 160.0);
  }
  EXPECT_LE(most, 51u + 301u);
}

TEST(LaneMemory, ALaneThatLiesElsewhereHasNoPast) {
  LaneMemory memory;
  memory.remember(window(0.0));
  EXPECT_EQ(memory.remember(window(50.0, 3.5)).lanes[0].center.front().x(), 50.0);
  EXPECT_EQ(memory.remember(window(60.0, 3.5, "b")).lanes[0].center.front().x(), 60.0);
}

}  // namespace
}  // namespace relative_map::core::test
