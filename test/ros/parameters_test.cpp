#include "relative_map/ros/setup/parameters.hpp"

#include <XmlRpcValue.h>
#include <gmock/gmock.h>

#include <filesystem>
#include <fstream>
#include <set>
#include <sstream>

// Relative to the package, whose folder CMake names.
#define SOURCE_FILE(name) RELATIVE_MAP_SOURCE_DIR "/" name

namespace relative_map {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

/// Every number, word and switch of a configuration, by name.
std::map<std::string, std::string> described(const NodeConfig& config) {
  const core::PipelineConfig& p = config.pipeline;
  const core::NavigationLaneParam& lane = p.navigation_lane;
  const std::map<std::string, double> numbers = {
      {"rate", config.rate},
      {"use_navigation_mode", config.use_navigation_mode},
      {"rfu", config.orientation_convention == OrientationConvention::kRfu},
      {"enable_cyclic_rerouting", p.enable_cyclic_rerouting},
      {"generate_left_boundary", p.generate_left_boundary},
      {"predict_to_tick", p.predict_to_tick},
      {"default_left_width", p.map_param.default_left_width},
      {"default_right_width", p.map_param.default_right_width},
      {"default_speed_limit", p.map_param.default_speed_limit},
      {"perception", lane.lane_source == core::LaneSource::kPerception},
      {"max_len_from_navigation_line", lane.max_len_from_navigation_line},
      {"min_len_for_navigation_lane", lane.min_len_for_navigation_lane},
      {"max_len_for_navigation_lane", lane.max_len_for_navigation_lane},
      {"ratio_navigation_lane_len_to_speed", lane.ratio_navigation_lane_len_to_speed},
      {"max_distance_to_navigation_line", lane.max_distance_to_navigation_line},
      {"min_view_range_to_use_lane_marker", lane.min_view_range_to_use_lane_marker},
      {"min_lane_marker_quality", lane.min_lane_marker_quality},
      {"min_lane_half_width", lane.min_lane_half_width},
      {"max_lane_half_width", lane.max_lane_half_width},
      {"lane_marker_weight", lane.lane_marker_weight},
      {"max_offset", p.lane_fusion.max_offset},
      {"decay_time", p.lane_fusion.decay_time},
      {"hold_time", p.lane_fusion.hold_time},
      {"fade_length", p.lane_fusion.fade_length},
      {"max_age/localization", p.max_age.localization},
      {"max_age/chassis", p.max_age.chassis},
      {"max_age/lane_markers", p.max_age.lane_markers},
      {"min_rate/localization", config.min_rate.localization},
      {"min_rate/chassis", config.min_rate.chassis},
      {"min_rate/lane_markers", config.min_rate.lane_markers},
      {"half_width", p.footprint.half_width},
      {"front_overhang", p.footprint.front_overhang},
      {"rear_overhang", p.footprint.rear_overhang},
  };
  std::map<std::string, std::string> texts = {
      {"base_frame", p.base_frame}, {"map_frame", config.map_frame}, {"method", p.lane_fusion.method}};
  for (const auto& [name, number] : numbers) {
    std::ostringstream text;
    text.precision(17);
    text << number;
    texts[name] = text.str();
  }
  return texts;
}

/// The text of the refusal, or "accepted".
std::string refusal_of(const ParameterSet& parameters, const std::string& urdf = "") {
  try {
    make_node_config(parameters, urdf);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "accepted";
}

std::string refusal_of_file(const std::string& file) {
  try {
    read_yaml(file);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "accepted";
}

/// A YAML file that lasts as long as the test.
class YamlFile {
 public:
  explicit YamlFile(const std::string& text)
      : path_(testing::TempDir() + testing::UnitTest::GetInstance()->current_test_info()->name() + ".yaml") {
    std::ofstream(path_) << text;
  }
  ~YamlFile() { std::filesystem::remove(path_); }
  const std::string& path() const { return path_; }

 private:
  std::string path_;
};

/// Each key that config/relative_map.yaml names, those that are commented out included.
ParameterSet all_keys() {
  std::ifstream shipped(SOURCE_FILE("config/relative_map.yaml"));
  std::string text, line;
  while (std::getline(shipped, line)) {
    const bool optional = line.rfind("# footprint:", 0) == 0 || line.rfind("#   ", 0) == 0;
    text += (optional ? line.substr(2) : line) + "\n";
  }
  return read_yaml(YamlFile(text).path());
}

TEST(Parameters, TheShippedFileHoldsTheDefaults) {
  const NodeConfig shipped = make_node_config(read_yaml(SOURCE_FILE("config/relative_map.yaml")), "");
  EXPECT_EQ(described(shipped), described(NodeConfig()));
}

TEST(Parameters, TheShippedFileNamesEveryKey) {
  const ParameterSet keys = all_keys();
  EXPECT_EQ(described(make_node_config(keys, "")), described(NodeConfig()));
  // Each is read, so a wrong type under each name is refused.
  for (const auto& [key, value] : keys) {
    const bool is_number = std::holds_alternative<double>(value);
    const Parameter wrong = is_number ? Parameter(std::string("ten")) : Parameter(0.5);
    EXPECT_THAT(refusal_of({{key, wrong}}),
                HasSubstr(key + " is '" + (is_number ? "ten" : "0.5") + "', but"));
  }
  // `described` has every number, switch and word but the two that it renames.
  EXPECT_EQ(keys.size(), described(NodeConfig()).size());
}

TEST(Parameters, EveryShippedFileIsAccepted) {
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(SOURCE_FILE("config"))) {
    // Those of other nodes are accepted by tests of their own.
    const std::set<std::string> of_others = {
        "simulator_errors.yaml", "simulator_sensors.yaml", "route.yaml",        "prediction.yaml",
        "adapters.yaml",         "localization.yaml",      "ndt_localizer.yaml"};
    if (entry.path().extension() != ".yaml" || of_others.count(entry.path().filename()) > 0) continue;
    EXPECT_EQ(refusal_of(read_yaml(entry.path())), "accepted") << entry.path();
    ++files;
  }
  EXPECT_GE(files, 1u);
}

TEST(Parameters, NoneGivesTheDefaults) {
  EXPECT_EQ(described(make_node_config({}, "")), described(NodeConfig()));
}

TEST(Parameters, EachValueArrivesAtItsPlace) {
  ParameterSet parameters = all_keys();
  std::map<std::string, std::string> expected = described(NodeConfig());
  for (auto& [key, value] : parameters) {
    const bool whole = key.rfind("max_age", 0) == 0 || key.rfind("min_rate", 0) == 0;
    const std::string leaf = whole ? key : key.substr(key.rfind('/') + 1);
    if (auto* number = std::get_if<double>(&value)) {
      *number += 0.125;
      std::ostringstream text;
      text.precision(17);
      text << *number;
      expected.at(leaf) = text.str();
    } else if (auto* flag = std::get_if<bool>(&value); flag && key != "use_navigation_mode") {
      *flag = !*flag;
      expected.at(leaf) = *flag ? "1" : "0";
    }
  }
  parameters["base_frame"] = std::string("rear_axle");
  parameters["map_frame"] = std::string("utm");
  parameters["orientation_convention"] = std::string("rfu");
  parameters["navigation_lane/lane_source"] = std::string("PERCEPTION");
  expected["base_frame"] = "rear_axle";
  expected["map_frame"] = "utm";
  expected["rfu"] = expected["perception"] = "1";
  EXPECT_EQ(described(make_node_config(parameters, "")), expected);
}

TEST(Parameters, AllFaultsAreListedTogether) {
  const std::string refusal = refusal_of({{"rate", std::string("fast")},
                                          {"ratte", 10.0},
                                          {"map_param/default_left_widht", 2.0},
                                          {"enable_cyclic_rerouting", 1},
                                          {"navigation_lane/lane_marker_weight", 1.5},
                                          {"navigation_lane/lane_source", std::string("CAMERA")},
                                          {"lane_fusion/method", std::string("magic")},
                                          {"navigation_lane/min_lane_half_width", 3.0},
                                          {"max_age/localization", 0.0},
                                          {"base_frame", std::string("")},
                                          {"footprint/half_width", -1.0}});
  EXPECT_THAT(refusal, AllOf(HasSubstr("rate is 'fast', but must be a number"),
                             HasSubstr("ratte is not a parameter of this node"),
                             HasSubstr("map_param/default_left_widht is not a parameter of this node"),
                             HasSubstr("enable_cyclic_rerouting is '1', but must be true or false"),
                             HasSubstr("navigation_lane/lane_marker_weight is 1.5, but must lie in [0, 1]"),
                             HasSubstr("navigation_lane/lane_source is 'CAMERA', but must be"),
                             HasSubstr("lane_fusion/method is 'magic', but must be"),
                             HasSubstr("navigation_lane/min_lane_half_width is 3, but must not exceed"),
                             HasSubstr("max_age/localization is 0, but must be above 0")));
  EXPECT_THAT(refusal, AllOf(HasSubstr("base_frame is empty"), HasSubstr("footprint/half_width is -1")));
  EXPECT_EQ(std::count(refusal.begin(), refusal.end(), '\n'), 11) << refusal;
}

TEST(Parameters, EachImpossibleValueIsRefusedByName) {
  const std::vector<std::pair<std::string, double>> bad = {
      {"rate", 0.0},
      {"rate", -10.0},
      {"rate", 1001.0},
      {"map_param/default_left_width", 0.0},
      {"map_param/default_right_width", 11.0},
      {"map_param/default_speed_limit", 0.0},
      {"navigation_lane/max_len_from_navigation_line", -250.0},
      {"navigation_lane/min_len_for_navigation_lane", 0.0},
      {"navigation_lane/min_len_for_navigation_lane", 251.0},
      {"navigation_lane/max_len_for_navigation_lane", 0.0},
      {"navigation_lane/ratio_navigation_lane_len_to_speed", 0.0},
      {"navigation_lane/max_distance_to_navigation_line", 0.0},
      {"navigation_lane/min_view_range_to_use_lane_marker", -0.1},
      {"navigation_lane/min_lane_marker_quality", 1.1},
      {"navigation_lane/min_lane_half_width", 0.1},
      {"navigation_lane/max_lane_half_width", 100.0},
      {"navigation_lane/lane_marker_weight", -0.1},
      {"lane_fusion/fade_length", 0.0},
      {"max_age/localization", -1.0},
      {"max_age/chassis", 0.0},
      {"max_age/lane_markers", 0.0},
      {"min_rate/localization", -1.0},
      {"min_rate/chassis", 1001.0},
      {"min_rate/lane_markers", -0.5},
      {"footprint/half_width", 0.0},
      {"footprint/front_overhang", -0.1},
      {"footprint/rear_overhang", -0.1},
  };
  for (const auto& [name, value] : bad) {
    EXPECT_THAT(refusal_of({{name, value}}), HasSubstr(name + " is ")) << value;
  }
}

TEST(Parameters, NumbersThatAreNotFiniteAreRefused) {
  for (const auto& [key, value] : all_keys()) {
    if (!std::holds_alternative<double>(value)) continue;
    EXPECT_THAT(refusal_of({{key, std::numeric_limits<double>::quiet_NaN()}}), HasSubstr(key + " is "));
    EXPECT_THAT(refusal_of({{key, std::numeric_limits<double>::infinity()}}), HasSubstr(key + " is "));
  }
}

TEST(Parameters, NavigationModeOffIsRefused) {
  EXPECT_THAT(refusal_of({{"use_navigation_mode", false}}), HasSubstr("use_navigation_mode is false"));
}

TEST(Parameters, IntegersCountAsNumbers) {
  EXPECT_EQ(make_node_config({{"rate", 20}}, "").rate, 20.0);
}

TEST(Parameters, FlattenNamesByPathAndLeavesOutReconfigure) {
  XmlRpc::XmlRpcValue tree;
  tree["rate"] = 20;
  tree["base_frame"] = "rear_axle";
  tree["map_param"]["default_left_width"] = 1.8;
  tree["enable_cyclic_rerouting"] = XmlRpc::XmlRpcValue(false);
  tree["reconfigure"]["default_left_width"] = 9.0;
  const ParameterSet expected = {{"rate", 20},
                                 {"base_frame", std::string("rear_axle")},
                                 {"map_param/default_left_width", 1.8},
                                 {"enable_cyclic_rerouting", false}};
  EXPECT_EQ(flatten(tree), expected);
  EXPECT_EQ(refusal_of(flatten(tree)), "accepted");
}

TEST(Parameters, OnlyTheNodesOwnReconfigureNamespaceIsLeftOut) {
  XmlRpc::XmlRpcValue tree;
  tree["map_param"]["reconfigure"] = 1.8;
  EXPECT_THAT(refusal_of(flatten(tree)), HasSubstr("map_param/reconfigure is not a parameter"));
}

/// As other nodes and libraries leave them there.
TEST(Parameters, WhatBelongsToOthersIsNoUnknownKey) {
  XmlRpc::XmlRpcValue tree;
  tree["rate"] = 20;
  tree["robot_description"] = "<robot name='car'/>";
  tree["diagnostic_period"] = 0.5;
  tree["tf_prefix"] = "car1";
  EXPECT_EQ(flatten(tree).size(), 1u);
  EXPECT_EQ(refusal_of(flatten(tree)), "accepted");
  tree["map_param"]["diagnostic_period"] = 1.0;
  EXPECT_THAT(refusal_of(flatten(tree)), HasSubstr("map_param/diagnostic_period is not a parameter"));
}

TEST(Parameters, SpeedLimitsAreReadByTheNameOfTheLine) {
  const NodeConfig config =
      make_node_config({{"map_param/speed_limits/left", 13.9}, {"map_param/speed_limits/a 1", 5}}, "");
  EXPECT_EQ(config.speed_limits, (std::map<std::string, double>{{"left", 13.9}, {"a 1", 5.0}}));
  EXPECT_THAT(refusal_of({{"map_param/speed_limits/left", 0.0}}),
              HasSubstr("map_param/speed_limits/left is 0"));
  EXPECT_THAT(refusal_of({{"map_param/speed_limits/left", std::string("fast")}}),
              HasSubstr("must be a number"));
  const YamlFile file("map_param:\n  speed_limits: {middle: 13.9}\n");
  EXPECT_EQ(make_node_config(read_yaml(file.path()), "").speed_limits.at("middle"), 13.9);
}

TEST(Parameters, FramesLoseTheSlashOfTf1) {
  const NodeConfig config = make_node_config(
      {{"base_frame", std::string("/car1/base_link")}, {"map_frame", std::string("/utm")}}, "");
  EXPECT_EQ(config.pipeline.base_frame, "car1/base_link");
  EXPECT_EQ(config.map_frame, "utm");
  EXPECT_THAT(refusal_of({{"base_frame", std::string("/")}}), HasSubstr("base_frame is empty"));
  EXPECT_THAT(refusal_of({{"map_frame", std::string("")}}), HasSubstr("map_frame is empty"));
}

TEST(Parameters, NoTreeFlattensToNone) {
  EXPECT_TRUE(flatten(XmlRpc::XmlRpcValue()).empty());
}

TEST(Parameters, AListIsRefusedByName) {
  XmlRpc::XmlRpcValue tree;
  tree["rate"][0] = 10.0;
  EXPECT_THAT(refusal_of(flatten(tree)), HasSubstr("rate is "));
  EXPECT_THAT(refusal_of(read_yaml(YamlFile("rate: [10.0]\n").path())), HasSubstr("rate is "));
}

TEST(Parameters, AGroupInPlaceOfAValueAndTheOtherWayRoundAreRefused) {
  EXPECT_THAT(refusal_of(read_yaml(YamlFile("rate: {hz: 10}\nmap_param: 3\nlane_fusion:\n").path())),
              AllOf(HasSubstr("rate/hz is not a parameter"), HasSubstr("map_param is not a parameter"),
                    HasSubstr("lane_fusion is not a parameter")));
}

TEST(Parameters, YamlIsReadWithItsTypes) {
  const YamlFile file("rate: 20\nbase_frame: '7'\nenable_cyclic_rerouting: false\nmax_age: {chassis: 2.0}\n");
  const ParameterSet expected = {{"rate", 20},
                                 {"base_frame", std::string("7")},
                                 {"enable_cyclic_rerouting", false},
                                 {"max_age/chassis", 2.0}};
  EXPECT_EQ(read_yaml(file.path()), expected);
}

TEST(Parameters, AnEmptyYamlFileGivesTheDefaults) {
  EXPECT_TRUE(read_yaml(YamlFile("# nothing\n").path()).empty());
}

TEST(Parameters, AYamlFileThatCantBeUsedIsNamed) {
  for (const char* text : {"rate: [10\n", "- rate\n- 10\n", "rate\n", "? [1, 2]\n: 3\n"}) {
    const YamlFile file(text);
    EXPECT_THAT(refusal_of_file(file.path()), HasSubstr(file.path())) << text;
  }
  EXPECT_THAT(refusal_of_file("/no/such/file.yaml"), HasSubstr("/no/such/file.yaml"));
}

}  // namespace
}  // namespace relative_map
