#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "random_scene.hpp"

// Drives of which nothing is as it should be: no road has these lines, no car these poses, no camera this
// paint.
namespace relative_map::core::test {

/// A line of any shape: hairpins, loops, knots, zigzags, about-turns, lines along themselves, single points.
RecordedLine ugly_line(Random& random, const std::string& name);

/// Markers of any numbers, NaN and infinity among them.
LaneMarkers ugly_markers(Random& random, Time now);

/// A configuration that passes validation, and nothing else.
PipelineConfig ugly_config(Random& random);

/// What comes in between two ticks; none: nothing of it.
struct UglyInputs {
  std::optional<std::vector<RecordedLine>> lines;
  IntakeParam intake;  ///< of the lines
  std::optional<PipelineConfig> config;
  std::optional<Localization> localization;
  std::optional<Chassis> chassis;
  std::optional<LaneMarkers> markers;
};

class UglyDrive {
 public:
  explicit UglyDrive(std::uint64_t seed) : random_(seed) {}

  /// Time goes on, stands or leaps; lines and configuration change now and then.
  UglyInputs next();
  void step(RelativeMapPipeline& pipeline);
  Time now() const { return now_; }

 private:
  void change_lines();
  void move_vehicle();
  void put_beside_a_line();
  Localization localization();

  Random random_;
  std::vector<RecordedLine> lines_;
  IntakeParam intake_;
  Pose2 pose_;
  double speed_ = 10.0;
  Time now_ = at_seconds(100000.0);
};

}  // namespace relative_map::core::test
