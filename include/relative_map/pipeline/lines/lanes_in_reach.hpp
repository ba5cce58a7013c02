#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"

namespace relative_map::core {

struct TrackedLine {
  const NavigationLine* line;
  LineProjection projection;
};

/// Keeps the vehicle's place on every line, and finds those that it can be on.
class LanesInReach {
 public:
  void set_lines(std::shared_ptr<const NavigationLines> lines);
  /// Forgets the places, not the lines.
  void reset();

  /// The lines in reach, or why there is none. Each line that drops out leaves a sentence in `remarks`; many
  /// of them share one.
  std::variant<std::vector<TrackedLine>, Status> track(const VehicleState& vehicle,
                                                       const PipelineConfig& config,
                                                       std::vector<std::string>& remarks);

 private:
  std::vector<TrackedLine> track_all(const VehicleState& vehicle, double max_distance,
                                     std::vector<LineDrop>& drops);

  std::shared_ptr<const NavigationLines> lines_;
  std::vector<NavigationLineTracker> trackers_;  ///< one a line
};

}  // namespace relative_map::core
