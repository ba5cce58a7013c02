#pragma once

#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "relative_map/model/prediction_config.hpp"
#include "relative_map/prediction/noise_meter.hpp"
#include "relative_map/prediction/road_user.hpp"

namespace relative_map::core {

/// Remembers road users from frame to frame, in the map frame, by their ids.
/// A frame that is not newer than the last one is dropped; a stamp that jumps, or that keeps running from an
/// earlier time on, forgets everything: time has been set back. What can't be true of a road user (a position
/// that is not finite, an impossible speed) is left out, with a sentence, and the others are kept.
class RoadUserStore {
 public:
  RoadUserStore(const RoadUserStoreParam& store, const MotionFilterParam& filter);

  /// `center`: where the vehicle is; of too many road users the nearest to it are kept.
  void add(const SeenRoadUsers& frame, const Point2& center);
  /// Those that are seen now or were within max_age, by rising id.
  std::vector<const RoadUser*> present(Time now) const;
  /// What was odd about the last frame, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }
  std::optional<Time> newest() const { return newest_; }
  double position_stddev() const { return noise_.stddev(); }
  std::size_t size() const { return users_.size(); }
  void clear();

 private:
  bool accepts(Time stamp);
  std::vector<SeenRoadUser> plausible(const SeenRoadUsers& frame, const Point2& center);
  void add(Time stamp, const SeenRoadUser& seen);
  void measure_noise();

  RoadUserStoreParam param_;
  MotionFilterParam filter_;
  NoiseMeter noise_;
  std::unordered_map<int, RoadUser> users_;
  std::optional<Time> newest_;
  std::optional<Time> dropped_;  ///< the last stamp that was too old
  int dropped_in_a_row_ = 0;     ///< with rising stamps
  std::vector<std::string> remarks_;
};

}  // namespace relative_map::core
