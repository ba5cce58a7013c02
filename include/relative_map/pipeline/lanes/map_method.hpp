#pragma once

#include <algorithm>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lanes/map_builder.hpp"
#include "relative_map/pipeline/lines/lanes_in_reach.hpp"
#include "relative_map/pipeline/motion/motion_inputs.hpp"

namespace relative_map::core {

/// What a tick starts from.
struct Tick {
  Time now;
  Time not_before;                ///< the stamp of the last map: the next one's is no earlier
  const VehicleState& localized;  ///< at the time of the newest pose
  const MotionInputs& motion;
  const PipelineConfig& config;
  LanesInReach& lines;
  const std::string& current_id;      ///< of the last map
  std::vector<std::string>& remarks;  ///< what is noticed goes here, a sentence each

  /// `vehicle`, a place of the newest pose's time, at the time that the map is for: stamps never go back.
  VehicleState at_map_time(const VehicleState& vehicle) const {
    const Time wanted = std::max(not_before, config.predict_to_tick ? now : vehicle.stamp);
    return wanted == vehicle.stamp ? vehicle : motion.carried_to(wanted, vehicle);
  }
  /// The lines that the vehicle can be on, or why there is none.
  std::variant<TrackedLines, Status> lines_in_reach(const VehicleState& vehicle) const;
};

/// The lanes around the vehicle: all that a map is made of.
struct FoundLanes {
  VehicleState vehicle;         ///< that they are seen from
  std::vector<LanePath> lanes;  ///< left to right, none too narrow
  std::size_t current = 0;      ///< the one that the vehicle is in
  SeenPaint paint;              ///< beside that one
  FusionState fusion;           ///< but for the half widths, which the borders tell
};

/// How lanes come out of lines and lane markers.
class MapMethod {
 public:
  virtual ~MapMethod() = default;
  /// The vehicle is at another place.
  virtual void move(const VehicleState& localized, const PipelineConfig& config) = 0;
  /// An image, in the order of arrival.
  virtual void see(const LaneMarkers& markers) = 0;
  /// Speed or yaw rate have turned out to be wrong, and with them what was made of them.
  virtual void doubt_motion() = 0;
  /// Forgets everything, as after a jump of the clock.
  virtual void reset() = 0;
  /// The lanes at this tick, or why there is none.
  virtual std::variant<FoundLanes, Status> find_lanes(const Tick& tick) = 0;
};

}  // namespace relative_map::core
