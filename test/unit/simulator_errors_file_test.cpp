// config/simulator_errors.yaml says what accuracy_benchmark does.
#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <map>
#include <string>

#include "relative_map/simulation/accuracy_scenes.hpp"

namespace relative_map::core {
namespace {

std::map<std::string, double> usual_errors() {
  VehicleSimulationConfig config;
  set_usual_errors(config);
  const NoiseParam& noise = config.noise;
  const LocalizationErrorParam& localization = config.errors.localization;
  const RecordingErrorParam& recording = config.errors.recording;
  const MarkerErrorParam& markers = config.errors.markers;
  return {{"noise/localization_position", noise.localization_position},
          {"noise/localization_heading", noise.localization_heading},
          {"noise/yaw_rate", noise.yaw_rate},
          {"noise/chassis_speed", noise.chassis_speed},
          {"noise/marker_c0", noise.marker_c0},
          {"noise/marker_c1", noise.marker_c1},
          {"noise/marker_c2", noise.marker_c2},
          {"noise/marker_c3", noise.marker_c3},
          {"errors/localization_bias", localization.bias},
          {"errors/localization_bias_time", localization.bias_time},
          {"errors/heading_bias", localization.heading_bias},
          {"errors/heading_bias_time", localization.heading_bias_time},
          {"errors/drift", localization.drift},
          {"errors/drift_time", localization.drift_time},
          {"errors/yaw_rate_bias", localization.yaw_rate_bias},
          {"errors/speed_scale", config.errors.chassis.speed_scale},
          {"errors/recording_offset", recording.offset},
          {"errors/recording_wander", recording.wander},
          {"errors/recording_wander_length", recording.wander_length},
          {"errors/marker_correlated_share", markers.correlated_share},
          {"errors/marker_correlation_time", markers.correlation_time},
          {"errors/marker_common_share", markers.common_share},
          {"errors/view_range_change", markers.view_range_change},
          {"errors/view_range_time", markers.view_range_time},
          {"errors/min_view_range", markers.min_view_range},
          {"errors/max_view_range", markers.max_view_range},
          {"errors/dropout_interval", markers.dropout.interval},
          {"errors/dropout_min_duration", markers.dropout.min_duration},
          {"errors/dropout_max_duration", markers.dropout.max_duration},
          {"errors/outlier_interval", markers.outlier.interval},
          {"errors/outlier_min_duration", markers.outlier.min_duration},
          {"errors/outlier_max_duration", markers.outlier.max_duration},
          {"errors/min_jump", markers.min_jump},
          {"errors/max_jump", markers.max_jump},
          {"errors/min_latency", markers.min_latency},
          {"errors/max_latency", markers.max_latency},
          {"max_turn", config.paint.max_turn},
          {"max_residual", config.paint.max_residual}};
}

std::map<std::string, double> numbers_of(const YAML::Node& file) {
  std::map<std::string, double> numbers;
  for (const auto& entry : file) {
    const auto key = entry.first.as<std::string>();
    if (!entry.second.IsMap()) {
      numbers[key] = entry.second.as<double>();
      continue;
    }
    for (const auto& inner : entry.second) {
      numbers[key + "/" + inner.first.as<std::string>()] = inner.second.as<double>();
    }
  }
  return numbers;
}

TEST(SimulatorErrorsFile, HasTheUsualErrorsAndNoOthers) {
  const auto expected = usual_errors(),
             found = numbers_of(YAML::LoadFile(RELATIVE_MAP_SOURCE_DIR "/config/simulator_errors.yaml"));
  EXPECT_EQ(found.size(), expected.size());
  for (const auto& [key, value] : expected) {
    ASSERT_EQ(found.count(key), 1u) << key;
    EXPECT_NEAR(found.at(key), value, 1e-3 * value) << key;
  }
}

}  // namespace
}  // namespace relative_map::core
