#include "relative_map/model/config.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <limits>
#include <utility>

namespace relative_map::core {
namespace {

using testing::HasSubstr;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

using Member = std::function<double&(PipelineConfig&)>;

const std::vector<std::pair<std::string, Member>>& numbers() {
  static const std::vector<std::pair<std::string, Member>> members = {
      {"map_param/default_left_width", [](auto& c) -> double& { return c.map_param.default_left_width; }},
      {"map_param/default_right_width", [](auto& c) -> double& { return c.map_param.default_right_width; }},
      {"map_param/default_speed_limit", [](auto& c) -> double& { return c.map_param.default_speed_limit; }},
      {"navigation_lane/max_len_from_navigation_line",
       [](auto& c) -> double& { return c.navigation_lane.max_len_from_navigation_line; }},
      {"navigation_lane/min_len_for_navigation_lane",
       [](auto& c) -> double& { return c.navigation_lane.min_len_for_navigation_lane; }},
      {"navigation_lane/max_len_for_navigation_lane",
       [](auto& c) -> double& { return c.navigation_lane.max_len_for_navigation_lane; }},
      {"navigation_lane/ratio_navigation_lane_len_to_speed",
       [](auto& c) -> double& { return c.navigation_lane.ratio_navigation_lane_len_to_speed; }},
      {"navigation_lane/max_distance_to_navigation_line",
       [](auto& c) -> double& { return c.navigation_lane.max_distance_to_navigation_line; }},
      {"navigation_lane/min_view_range_to_use_lane_marker",
       [](auto& c) -> double& { return c.navigation_lane.min_view_range_to_use_lane_marker; }},
      {"navigation_lane/min_lane_marker_quality",
       [](auto& c) -> double& { return c.navigation_lane.min_lane_marker_quality; }},
      {"navigation_lane/min_lane_half_width",
       [](auto& c) -> double& { return c.navigation_lane.min_lane_half_width; }},
      {"navigation_lane/max_lane_half_width",
       [](auto& c) -> double& { return c.navigation_lane.max_lane_half_width; }},
      {"navigation_lane/lane_marker_weight",
       [](auto& c) -> double& { return c.navigation_lane.lane_marker_weight; }},
      {"lane_fusion/max_offset", [](auto& c) -> double& { return c.lane_fusion.max_offset; }},
      {"lane_fusion/decay_time", [](auto& c) -> double& { return c.lane_fusion.decay_time; }},
      {"lane_fusion/hold_time", [](auto& c) -> double& { return c.lane_fusion.hold_time; }},
      {"lane_fusion/fade_length", [](auto& c) -> double& { return c.lane_fusion.fade_length; }},
      {"max_age/localization", [](auto& c) -> double& { return c.max_age.localization; }},
      {"max_age/chassis", [](auto& c) -> double& { return c.max_age.chassis; }},
      {"max_age/lane_markers", [](auto& c) -> double& { return c.max_age.lane_markers; }},
      {"footprint/half_width", [](auto& c) -> double& { return c.footprint.half_width; }},
      {"footprint/front_overhang", [](auto& c) -> double& { return c.footprint.front_overhang; }},
      {"footprint/rear_overhang", [](auto& c) -> double& { return c.footprint.rear_overhang; }},
  };
  return members;
}

TEST(Config, DefaultsAreTheDescriptionsAndFitToRunWith) {
  const PipelineConfig config;
  EXPECT_TRUE(config.validate().empty());
  EXPECT_EQ(config.map_param.default_left_width, 1.75);
  EXPECT_EQ(config.map_param.default_right_width, 1.75);
  EXPECT_EQ(config.map_param.default_speed_limit, 29.06);
  EXPECT_EQ(config.navigation_lane.lane_source, LaneSource::kOfflineGenerated);
  EXPECT_EQ(config.navigation_lane.max_len_from_navigation_line, 250.0);
  EXPECT_EQ(config.navigation_lane.min_len_for_navigation_lane, 150.0);
  EXPECT_EQ(config.navigation_lane.max_len_for_navigation_lane, 250.0);
  EXPECT_EQ(config.navigation_lane.ratio_navigation_lane_len_to_speed, 8.0);
  EXPECT_EQ(config.navigation_lane.max_distance_to_navigation_line, 15.0);
  EXPECT_EQ(config.navigation_lane.min_view_range_to_use_lane_marker, 0.5);
  EXPECT_EQ(config.navigation_lane.min_lane_half_width, 1.5);
  EXPECT_EQ(config.navigation_lane.max_lane_half_width, 2.0);
  EXPECT_EQ(config.navigation_lane.lane_marker_weight, 0.1);
  EXPECT_EQ(config.navigation_lane.min_lane_marker_quality, 0.5);
}

TEST(Config, EveryNumberIsCheckedAndNamed) {
  for (const auto& [name, member] : numbers()) {
    for (const double bad : {-1.0, kNaN, kInfinity}) {
      PipelineConfig config;
      member(config) = bad;
      const std::vector<std::string> faults = config.validate();
      ASSERT_FALSE(faults.empty()) << name << " = " << bad;
      EXPECT_THAT(faults, testing::Contains(HasSubstr(name)));
    }
  }
}

TEST(Config, AllFaultsAreNamedAtOnceWithTheirValues) {
  PipelineConfig config;
  config.map_param.default_speed_limit = -3.5;
  config.navigation_lane.lane_marker_weight = 1.5;
  config.lane_fusion.method = "magic";
  config.base_frame = "";
  const std::vector<std::string> faults = config.validate();
  ASSERT_EQ(faults.size(), 4u);
  EXPECT_THAT(faults, testing::Contains(HasSubstr("map_param/default_speed_limit is -3.5")));
  EXPECT_THAT(faults, testing::Contains(HasSubstr("navigation_lane/lane_marker_weight is 1.5")));
  EXPECT_THAT(faults, testing::Contains(HasSubstr("lane_fusion/method is 'magic'")));
  EXPECT_THAT(faults, testing::Contains(HasSubstr("base_frame is empty")));
}

TEST(Config, LimitsMustBeInOrder) {
  PipelineConfig lengths;
  lengths.navigation_lane.min_len_for_navigation_lane = 300.0;
  EXPECT_THAT(lengths.validate(), testing::ElementsAre(HasSubstr("must not exceed navigation_lane/max_len")));
  PipelineConfig widths;
  widths.navigation_lane.min_lane_half_width = 2.5;
  EXPECT_THAT(widths.validate(), testing::ElementsAre(HasSubstr("must not exceed navigation_lane/max_lane")));
}

TEST(Config, BothEndsOfTheWeightAreAllowed) {
  PipelineConfig config;
  config.navigation_lane.lane_marker_weight = 0.0;
  EXPECT_TRUE(config.validate().empty());
  config.navigation_lane.lane_marker_weight = 1.0;
  EXPECT_TRUE(config.validate().empty());
}

}  // namespace
}  // namespace relative_map::core
