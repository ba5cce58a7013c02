#include "relative_map/pipeline/lines/lanes_in_reach.hpp"

#include <gmock/gmock.h>

#include <algorithm>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(LanesInReach, AreTheBestWhereThereAreTooMany) {
  std::vector<RecordedLine> recorded;
  for (std::uint32_t i = 0; i < 20; ++i) {  // the later, the better
    recorded.push_back(test::recording(test::straight(Pose2(Point2(0.0, 3.5 * i), 0.0), 100.0, 1.0),
                                       std::to_string(i), 19 - i));
  }
  LanesInReach lanes;
  lanes.set_lines(prepare_navigation_lines({"map", recorded}, IntakeParam()));
  PipelineConfig config;
  config.navigation_lane.max_distance_to_navigation_line = 100.0;
  std::vector<std::string> remarks;
  const auto found = lanes.track(test::vehicle_at(Pose2(Point2(50.0, 1.0), 0.0)), config, "", remarks);
  const auto* tracked = std::get_if<TrackedLines>(&found);
  ASSERT_TRUE(tracked);
  EXPECT_EQ(tracked->lines.size(), 16u);
  EXPECT_EQ(tracked->current_line().line->id, "0") << "the vehicle is on the worst of them";
  for (const TrackedLine& line : tracked->lines) {
    EXPECT_TRUE(line.line->id == "0" || line.line->priority < 15u) << line.line->id;
  }
  EXPECT_THAT(remarks, Contains(HasSubstr("20 lines are in reach: only the best 16 are used")));
}

}  // namespace
}  // namespace relative_map::core
