#pragma once

#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "relative_map/pipeline/relative_map_pipeline.hpp"

// Recordings, and outputs of the original, from outside of the package.
namespace relative_map::core::test {

/// The folder of the reference data, without a slash at its end; none if it is not there.
std::optional<std::string> reference_folder();

/// Throws where the file is missing or no JSON.
nlohmann::json read_json(const std::string& file);

/// A scenario of the original, driven through the pipeline frame by frame.
class ScenarioRun {
 public:
  /// By its name in the folder `golden`.
  explicit ScenarioRun(const std::string& name);

  std::size_t frames() const { return scenario_["frames"].size(); }
  /// Gives the inputs of the next frame, and makes its map.
  RelativeMap next();
  const RelativeMapPipeline& pipeline() const { return pipeline_; }

 private:
  nlohmann::json scenario_;
  std::size_t frame_ = 0;
  RelativeMapPipeline pipeline_;
};

}  // namespace relative_map::core::test

/// Skips a test where there is no reference data.
#define REQUIRE_REFERENCE_DATA()                     \
  if (!relative_map::core::test::reference_folder()) \
  GTEST_SKIP() << "the reference data is not there: set RELATIVE_MAP_REFERENCE_DATA to its folder"
