#pragma once

#include <optional>

#include "relative_map/pipeline/lanes/map_method.hpp"
#include "relative_map/pipeline/lanes/marker_path.hpp"

namespace relative_map::core {

/// As the original fuses: the lane is pulled from the line towards the newest image by a fixed weight.
class FixedWeightMethod : public MapMethod {
 public:
  void move(const VehicleState&, const PipelineConfig&) override {}
  void see(const LaneMarkers& markers) override { markers_ = markers; }
  void doubt_motion() override {}
  void reset() override { markers_.reset(); }
  std::variant<FoundLanes, Status> find_lanes(const Tick& tick) override;

 private:
  /// None: there are no markers of use.
  std::optional<MarkerPath> marker_path(const VehicleState& vehicle, const Tick& tick) const;

  std::optional<LaneMarkers> markers_;
};

}  // namespace relative_map::core
