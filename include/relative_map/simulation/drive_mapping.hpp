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
  bool is_filter = false;  ///< ReferenceMapMaker's in place of the pipeline

  PipelineConfig config(LaneSource lane_source) const;
};

/// The published original's fusion, the lines alone, and the estimator; those that this build knows.
std::vector<AccuracyMethod> accuracy_methods();

/// The plain filter that the estimator is compared with.
AccuracyMethod reference_method();

/// What turns a drive's messages into maps.
class MapMaker {
 public:
  virtual ~MapMaker() = default;
  virtual void deliver(const Delivery& delivery) = 0;
  virtual RelativeMap tick(Time now) = 0;
  /// On the map that was made last.
  virtual std::string remarks() const { return ""; }
  /// What of the output contract that map breaks, a sentence each.
  virtual std::vector<std::string> violations(const RelativeMap& /*map*/) { return {}; }
};

/// Plays the drive into it, and ticks it ten times a second. The first second, in which there may be no map
/// yet, is left out.
std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, MapMaker& maker);

/// The same with the pipeline that the node runs.
std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const PipelineConfig& config,
                                   bool deliver_markers);
std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const AccuracyMethod& method,
                                   LaneSource lane_source);

}  // namespace relative_map::core
