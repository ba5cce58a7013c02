#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/motion/pose_buffer.hpp"
#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

/// Keeps the images that came since the last tick, and carries their paint to where the vehicle is now, by
/// odometry: localization's noise and jumps do not move paint.
class ImageQueue {
 public:
  struct Image {
    Time stamp{};
    SeenSides sides;
  };

  void move(const VehicleState& localized);
  void add(const LaneMarkers& markers);
  void clear() { *this = ImageQueue(); }

  /// The images of use, oldest first, as seen from the pose of time `pose_stamp`; the queue is empty then.
  /// Old ones are dropped; others of no use leave a sentence.
  std::vector<Image> take(Time now, Time pose_stamp, const PipelineConfig& config,
                          std::vector<std::string>& remarks);

 private:
  std::optional<Image> look_at(const LaneMarkers& markers, Time pose_stamp, const PipelineConfig& config,
                               std::vector<std::string>& remarks);

  /// Whether each marker that is seen says what it said when it was last seen.
  bool is_unchanged(const LaneMarkers& markers);
  bool is_frozen(const LaneMarkers& markers, bool unchanged);

  std::vector<LaneMarkers> waiting_;
  Cubic last_left_, last_right_;
  std::optional<LaneMarkers> same_since_;  ///< the first image of those that say the same numbers
  bool frozen_ = false;
  PoseBuffer odometry_;  ///< poses by speed and yaw rate alone, from an origin of its own
  std::optional<VehicleState> last_;
};

}  // namespace relative_map::core
