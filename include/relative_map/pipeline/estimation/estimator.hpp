#pragma once

#include <string>
#include <vector>

#include "relative_map/pipeline/estimation/lane_estimator.hpp"
#include "relative_map/pipeline/lanes/map_method.hpp"
#include "relative_map/pipeline/paint/image_queue.hpp"

namespace relative_map::core {

/// What the estimator has to say after the images of a tick.
struct LaneEstimate {
  VehicleState vehicle;  ///< where it is, at the time of the map
  FusionState fusion;    ///< the offset of the lane from the line, and how much paint backs it: FUSED, if any
  SeenPaint paint;       ///< beside the lane; from and to [m] are counted from the vehicle
  std::vector<std::string> remarks;
};

/// Where the vehicle is among its lines, and where the lane that it is in lies beside its line.
class Estimator {
 public:
  explicit Estimator(const SensorNoise& noise) : lane_(noise) {}

  /// Odometry up to `localized`, and what localization says there.
  void move(const VehicleState& localized, const LaneFusionParam& param) { lane_.move(localized, param); }
  void doubt_motion() { lane_.doubt_motion(); }
  void reset() { lane_.reset(); }

  /// `localized` without what is known to be wrong with it.
  VehicleState vehicle(const VehicleState& localized) const { return lane_.corrected(localized); }
  /// Once a tick: what its images, oldest first, say of the lane that the vehicle is in. `lines` are those in
  /// reach, seen from vehicle(localized) at the time of the map.
  LaneEstimate update(const std::vector<ImageQueue::Image>& images, const TrackedLines& lines,
                      const Tick& tick);
  /// Moves the current lane, the window of `line`, to where it is beside that line, and sets its half widths;
  /// returns whether it did: not without anything known of this line.
  bool move_lane(const TrackedLine& line, double least_half_width, LanePath& lane) const {
    return lane_.apply(*line.line, line.projection, least_half_width, lane);
  }
  /// Tells the lanes beside the current one where their far borders are, if paint showed it.
  void widen_beside(std::vector<LanePath>& lanes, std::size_t current) const {
    lane_.apply_beside(lanes, current);
  }

 private:
  LaneEstimator lane_;
};

}  // namespace relative_map::core
