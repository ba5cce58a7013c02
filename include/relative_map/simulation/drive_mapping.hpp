#pragma once

#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/simulation/accuracy_row.hpp"
#include "relative_map/simulation/recorded_drive.hpp"

namespace relative_map::core {

/// Makes the maps of a drive, and measures them.
struct AccuracyMethod {
  std::string name;
  std::string fusion = "fixed_weight";  ///< LaneFusionParam::method
  bool deliver_markers = true;

  PipelineConfig config(LaneSource lane_source) const;
};

/// The published original's fusion, the lines alone, and the estimator; those that this build knows.
std::vector<AccuracyMethod> accuracy_methods();

/// Plays the drive into the pipeline that the node runs, and ticks it ten times a second. The first second,
/// in which there may be no map yet, is left out.
std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const PipelineConfig& config,
                                   bool deliver_markers);

}  // namespace relative_map::core
