#pragma once

#include <optional>
#include <string>
#include <variant>

#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

namespace relative_map::core {

/// The vehicle's place on a line.
struct LineProjection {
  std::size_t nearest_vertex = 0;
  double s = 0.0;               ///< [m] of the foot; negative before the start of an open line
  double l = 0.0;               ///< [m] of the vehicle, left of the line positive
  double distance = 0.0;        ///< [m] to the line, its ends included
  double heading_offset = 0.0;  ///< [rad] of the vehicle from the line
  double remaining = 0.0;       ///< [m] to the line's end; a lap on a closed line
};

/// Why a line is of no use just now.
struct LineDrop {
  StatusCode code;  ///< kOffRoute or kLineEnd
  std::string reason;
};

/// Keeps the vehicle's place on one line from tick to tick.
class NavigationLineTracker {
 public:
  /// Where several passes of the line are about as near, the one that continues the last place counts,
  /// else the one whose heading fits. Passes that run the other way never count.
  std::variant<LineProjection, LineDrop> track(const NavigationLine& line, const VehicleState& vehicle,
                                               double max_distance);
  void reset() { last_.reset(); }

 private:
  struct Pass;
  struct Place {
    double s;
    Point2 direction;  ///< of the line there
    VehicleState vehicle;
  };

  std::optional<double> expected_s(const VehicleState& vehicle) const;
  const Pass& choose(const std::vector<Pass>& passes, const NavigationLine& line,
                     const VehicleState& vehicle) const;

  std::optional<Place> last_;
};

}  // namespace relative_map::core
