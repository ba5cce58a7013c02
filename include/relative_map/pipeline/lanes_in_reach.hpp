#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lane_path.hpp"
#include "relative_map/pipeline/navigation_line_tracker.hpp"

namespace relative_map::core {

/// Keeps the vehicle's place on every line, and cuts out those that it can be on.
class LanesInReach {
 public:
  void set_lines(std::shared_ptr<const NavigationLines> lines);
  /// Forgets the places, not the lines.
  void reset();

  /// The windows of the lines in reach, left to right, none too near a better one for the vehicle; or why
  /// there is none. Each line that drops out leaves a sentence in `remarks`; many of them share one.
  std::variant<std::vector<LanePath>, Status> find(const VehicleState& vehicle, const PipelineConfig& config,
                                                   std::vector<std::string>& remarks);

 private:
  struct Tracked {
    const NavigationLine* line;
    LineProjection projection;
  };

  std::vector<Tracked> track_all(const VehicleState& vehicle, double max_distance,
                                 std::vector<LineDrop>& drops);

  std::shared_ptr<const NavigationLines> lines_;
  std::vector<NavigationLineTracker> trackers_;  ///< one a line
};

}  // namespace relative_map::core
