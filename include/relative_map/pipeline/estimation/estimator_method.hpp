#pragma once

#include <vector>

#include "relative_map/pipeline/estimation/estimator.hpp"
#include "relative_map/pipeline/estimation/marker_lane_estimator.hpp"
#include "relative_map/pipeline/lanes/map_method.hpp"
#include "relative_map/pipeline/paint/image_queue.hpp"

namespace relative_map::core {

/// The lane is where odometry, localization and all paint that was seen so far put it.
class EstimatorMethod : public MapMethod {
 public:
  explicit EstimatorMethod(const SensorNoise& noise) : noise_(noise), estimator_(noise) {}

  void move(const VehicleState& localized, const PipelineConfig& config) override;
  void see(const LaneMarkers& markers) override;
  void doubt_motion() override;
  void reset() override { *this = EstimatorMethod(noise_); }
  std::variant<FoundLanes, Status> find_lanes(const Tick& tick) override;

 private:
  FoundLanes lanes_of_lines(TrackedLines lines, const std::vector<ImageQueue::Image>& images,
                            const Tick& tick);
  /// Where there is no line; `otherwise`, if there is no paint either.
  std::variant<FoundLanes, Status> lane_of_markers(const std::vector<ImageQueue::Image>& images,
                                                   Status otherwise, const Tick& tick);

  SensorNoise noise_;
  ImageQueue images_;
  std::optional<Time> last_image_;
  Estimator estimator_;
  MarkerLaneEstimator marker_estimator_;
};

}  // namespace relative_map::core
