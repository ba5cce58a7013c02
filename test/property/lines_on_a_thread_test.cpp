#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <thread>

#include "support/scene.hpp"

// Lines are prepared on one thread while another ticks, as in the node: to be run under a thread sanitizer,
// too.
namespace relative_map::core {
namespace {

using test::Scene;

std::vector<RecordedLine> three_lines(const std::string& suffix) {
  std::vector<RecordedLine> lines = test::three_straight_lines();
  for (RecordedLine& line : lines) line.name += suffix;
  return lines;
}

TEST(LinesOnAThread, AreTakenOverBetweenTicks) {
  std::mutex mutex;
  std::shared_ptr<const NavigationLines> prepared;
  std::atomic<bool> done{false};
  std::thread intake([&] {
    for (int i = 0; !done; ++i) {
      auto lines = prepare_navigation_lines({"map", three_lines(std::to_string(i))}, IntakeParam());
      const std::lock_guard<std::mutex> lock(mutex);
      prepared = std::move(lines);
    }
  });
  Scene scene(three_lines(""));
  std::size_t changes = 0;
  std::string before;
  for (int i = 0; changes < 20 && i < 100000; ++i) {
    std::shared_ptr<const NavigationLines> lines;
    {
      const std::lock_guard<std::mutex> lock(mutex);
      lines.swap(prepared);
    }
    if (lines) scene.pipeline().set_navigation_lines(std::move(lines));
    scene.see(test::lane_about({0.0}));
    const RelativeMap map = scene.at(Pose2(Point2(20.0 + i % 100, 0.0), 0.0));
    EXPECT_EQ(map.lanes.size(), 3u);
    changes += map.current_lane_id != before;
    before = map.current_lane_id;
  }
  done = true;
  intake.join();
  EXPECT_EQ(changes, 20u);
}

}  // namespace
}  // namespace relative_map::core
