// config/ndt_localizer.yaml against the node's parameters.
#include "relative_map/ros/lidar/ndt_parameters.hpp"

#include <gmock/gmock.h>

namespace relative_map {
namespace {

using testing::HasSubstr;

std::string refusal_of(const ParameterSet& parameters) {
  try {
    make_ndt_config(parameters);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

ParameterSet shipped_keys() {
  ParameterSet keys = read_yaml(RELATIVE_MAP_SOURCE_DIR "/config/ndt_localizer.yaml");
  keys["map"] = std::string("/maps/town");  // the one that every user must give
  return keys;
}

std::vector<double> numbers_of(const NdtNodeConfig& c) {
  const core::NdtBeliefParam& b = c.belief;
  return {c.max_age_odometry,
          c.max_gap,
          c.near,
          c.far,
          c.leaf,
          c.map_radius,
          c.map_reload,
          c.map_memory,
          c.start_radius,
          c.refusals,
          static_cast<double>(c.match.coarse_start),
          b.min_likelihood,
          b.upright_share,
          b.min_overlap,
          b.max_correction,
          b.max_turn,
          b.weak_share,
          b.weak_stddev,
          b.min_translation_stddev,
          b.min_rotation_stddev};
}

TEST(NdtParameters, TheFileHasTheDefaults) {
  const NdtNodeConfig of_file = make_ndt_config(shipped_keys());
  const NdtNodeConfig of_none = make_ndt_config({{"map", std::string("/maps/town")}});
  EXPECT_EQ(numbers_of(of_file), numbers_of(of_none));
  EXPECT_EQ(of_file.base_frame, of_none.base_frame);
}

TEST(NdtParameters, EachKeyOfTheFileIsReadAndThereAreNoOthers) {
  for (const auto& [key, value] : shipped_keys()) {
    ParameterSet wrong = shipped_keys();
    const bool is_text = std::holds_alternative<std::string>(value);
    wrong[key] = is_text ? Parameter(0.5) : Parameter(std::string("ten"));
    EXPECT_THAT(refusal_of(wrong), HasSubstr(key)) << key;
  }
  // All numbers and switches, the map and the frame.
  EXPECT_EQ(shipped_keys().size(), numbers_of(NdtNodeConfig()).size() + 2);
}

TEST(NdtParameters, EachValueArrives) {
  const std::vector<double> before = numbers_of(make_ndt_config(shipped_keys()));
  for (const auto& [key, value] : shipped_keys()) {
    if (key == "map" || key == "base_frame") continue;
    ParameterSet changed = shipped_keys();
    if (const auto* number = std::get_if<double>(&value)) changed[key] = *number * 1.01;
    if (const auto* whole = std::get_if<int>(&value)) changed[key] = *whole + 1;
    if (const auto* flag = std::get_if<bool>(&value)) changed[key] = !*flag;
    const std::vector<double> after = numbers_of(make_ndt_config(changed));
    int differences = 0;
    for (std::size_t i = 0; i < before.size(); ++i) differences += before[i] != after[i];
    EXPECT_EQ(differences, 1) << key;
  }
}

TEST(NdtParameters, EveryFaultIsNamedAtOnce) {
  ParameterSet wrong = shipped_keys();
  wrong["map"] = std::string();
  wrong["points/leaf"] = 0.0;
  wrong["points/near"] = 100.0;
  wrong["no_such_key"] = 1.0;
  const std::string text = refusal_of(wrong);
  for (const char* name : {"map must name", "points/leaf", "points/near must be less", "no_such_key"}) {
    EXPECT_THAT(text, HasSubstr(name));
  }
}

}  // namespace
}  // namespace relative_map
