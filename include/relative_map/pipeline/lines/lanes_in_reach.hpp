#pragma once

#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/lines/tracked_line.hpp"

namespace relative_map::core {

/// Keeps the vehicle's place on every line, and finds those that it can be on.
class LanesInReach {
 public:
  void set_lines(std::shared_ptr<const NavigationLines> lines);
  /// Forgets the places, not the lines.
  void reset();

  /// The lines in reach, or why there is none. The one that the vehicle is on (`current_id`: it was on) is
  /// chosen before any is left out, and never is. Each line that drops out leaves a sentence in `remarks`;
  /// many of them share one.
  std::variant<TrackedLines, Status> track(const VehicleState& vehicle, const PipelineConfig& config,
                                           const std::string& current_id, std::vector<std::string>& remarks);
  /// The same lines beside a vehicle that is known better now; it stays on the one that it is on. Lines that
  /// are out of reach from there drop out; if that were the current one, all stays as it is.
  void follow(TrackedLines& tracked, const VehicleState& vehicle, const PipelineConfig& config);

 private:
  NavigationLineTracker& tracker_of(const NavigationLine& line) {
    return trackers_[static_cast<std::size_t>(&line - lines_->lines.data())];
  }
  std::vector<TrackedLine> track_all(const VehicleState& vehicle, double max_distance,
                                     std::vector<LineDrop>& drops);

  std::shared_ptr<const NavigationLines> lines_;
  std::vector<NavigationLineTracker> trackers_;  ///< one a line
};

}  // namespace relative_map::core
