#pragma once

#include <optional>
#include <vector>

#include "relative_map/geometry/kalman_filter.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"

namespace relative_map::core {

/// The borders beyond those of the current lane, as far as paint shows them: their distance from that lane's
/// center.
class NeighbourBorders {
 public:
  struct Border {
    KalmanFilter<1> distance;                    ///< [m] from the current lane's center, positive
    std::optional<Time> seen;                    ///< the newest image that showed it
    double range = 0.0;                          ///< [m] ahead of the vehicle that it was seen to
    BoundaryType type = BoundaryType::kUnknown;  ///< in the newest image
  };

  /// The vehicle has driven `way` [m] in `seconds` [s].
  void move(double way, double seconds);
  /// Paint `distance` [m] (`variance` [m^2]) from the center of the lane, whose half width is `own` [m].
  void see(Border& border, Time stamp, double distance, double variance, double own, double range,
           BoundaryType type);
  /// The newest image does not show them.
  void see_nothing() { left.type = right.type = BoundaryType::kUnknown; }
  /// Tells the lanes beside the current one, `lanes[current]`, where their far borders are.
  void apply(std::vector<LanePath>& lanes, std::size_t current, Time now) const;

  Border left, right;
};

}  // namespace relative_map::core
