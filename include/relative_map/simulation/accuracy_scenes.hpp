#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/simulation/transmission.hpp"
#include "relative_map/simulation/true_road.hpp"
#include "relative_map/simulation/vehicle_simulation.hpp"

namespace relative_map::core {

enum class SceneGroup { kWithLine, kDrifting, kMarkersAlone, kBadMarkers, kPerfect };

/// What is wrong with all markers of a drive.
enum class MarkerFault {
  kNone,
  kLaneOff,   ///< a lane's width too far to the left
  kMirrored,  ///< left and right have changed places
  kFrozen,    ///< those of the first image again and again, with new stamps
  kFuture,    ///< stamped a second ahead
};

struct ErrorLevel {
  double scale = 1.0;  ///< errors so many times as large as usual; rates, delays and durations are not scaled
  bool harsh =
      false;  ///< cameras fail twice as often, and their noise lasts longer and is common to all paint
};

/// A drive whose truth is known.
struct AccuracyScene {
  std::string name;
  SceneGroup group = SceneGroup::kWithLine;
  RecordedLine reference;  ///< the road's reference curve, finely sampled
  std::vector<TrueLane> lanes;
  std::vector<RecordedLine> lines;                         ///< as recorded: with their errors
  double end_s = std::numeric_limits<double>::infinity();  ///< [m] along `reference`, where the lines end
  VehicleSimulationConfig vehicle;                         ///< drives along `reference`
  LaneSource lane_source = LaneSource::kOfflineGenerated;
  MarkerFault marker_fault = MarkerFault::kNone;
  SensorTransmission transmission;
  double duration = 90.0;  ///< [s]
};

std::vector<std::string> accuracy_scene_names();

/// The seed gives the road's shape and all errors.
/// Throws std::invalid_argument if there is no scene of that name.
AccuracyScene make_accuracy_scene(const std::string& name, std::uint64_t seed, const ErrorLevel& level = {});

/// A drive along a line that has really been driven: `line` is taken for the center of the only lane, and
/// recorded anew. Throws std::invalid_argument if it can't be driven on.
AccuracyScene make_line_scene(const RecordedLine& line, std::uint64_t seed, const ErrorLevel& level = {});

/// The errors that localization, recorded lines and cameras usually have.
void set_usual_errors(VehicleSimulationConfig& config, const ErrorLevel& level = {});

}  // namespace relative_map::core
