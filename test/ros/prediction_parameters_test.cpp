#include "relative_map/ros/setup/prediction_parameters.hpp"

#include <gmock/gmock.h>

namespace relative_map {
namespace {

using testing::HasSubstr;

const std::string kShipped = std::string(RELATIVE_MAP_SOURCE_DIR) + "/config/prediction.yaml";

std::string fault_of(const ParameterSet& parameters) {
  try {
    make_prediction_config(parameters);
  } catch (const std::runtime_error& fault) {
    return fault.what();
  }
  return "";
}

TEST(PredictionParameters, TheShippedFileNamesThemAllWithTheirDefaults) {
  const ParameterSet shipped = read_yaml(kShipped);
  const PredictionNodeConfig read = make_prediction_config(shipped), defaults = make_prediction_config({});
  std::vector<std::pair<std::string, std::string>> values, expected;
  const auto collect = [](auto& list) {
    return [&list](const std::string& name, const auto& value) {
      std::ostringstream text;
      text << value;
      list.emplace_back(name, text.str());
    };
  };
  core::visit_parameters(read.prediction, collect(values));
  core::visit_parameters(defaults.prediction, collect(expected));
  EXPECT_EQ(values, expected);
  for (const auto& [name, value] : values) EXPECT_EQ(shipped.count("prediction/" + name), 1u) << name;
  EXPECT_EQ(shipped.size(), values.size() + 6);
  EXPECT_EQ(read.rate, defaults.rate);
  EXPECT_EQ(read.base_frame, defaults.base_frame);
  EXPECT_EQ(read.publish_in_map_frame, defaults.publish_in_map_frame);
  EXPECT_EQ(read.max_localization_age, defaults.max_localization_age);
  EXPECT_EQ(read.max_map_age, defaults.max_map_age);
}

TEST(PredictionParameters, EveryFaultIsNamedAtOnce) {
  const std::string text = fault_of({{"prediction/lane/preview_time", -1.0},
                                     {"prediction/speed/max_headway", std::string("long")},
                                     {"prediction/nonsense", 1},
                                     {"output_frame", std::string("odom")},
                                     {"rate", 0.0}});
  EXPECT_THAT(text, HasSubstr("prediction/lane/preview_time is -1"));
  EXPECT_THAT(text, HasSubstr("prediction/speed/max_headway must be a number"));
  EXPECT_THAT(text, HasSubstr("prediction/nonsense is not a parameter"));
  EXPECT_THAT(text, HasSubstr("output_frame is 'odom'"));
  EXPECT_THAT(text, HasSubstr("rate must be"));
}

TEST(PredictionParameters, AnIntegerIsANumber) {
  EXPECT_EQ(make_prediction_config({{"prediction/lane/preview_time", 2}}).prediction.lane.preview_time, 2.0);
}

}  // namespace
}  // namespace relative_map
