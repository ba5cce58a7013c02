#pragma once

#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/prediction_config.hpp"

namespace relative_map::core {

/// The white noise of positions, measured from the positions themselves. The third difference of four at
/// equal steps leaves next to nothing of a motion (jerk times dt^3) and sqrt(20) times the noise.
class NoiseMeter {
 public:
  explicit NoiseMeter(const MotionFilterParam& param);

  /// Of one road user: four positions, the oldest first, `steps` [s] between them. Unequal steps tell
  /// nothing.
  void add(const Point2 positions[4], const double steps[3]);
  /// After all road users of a frame.
  void end_frame();
  /// [m] on each axis
  double stddev() const { return stddev_; }

 private:
  double least_, most_;
  double stddev_;
  double weight_ = 0.0;  ///< of what stddev_ rests on, in samples
  std::vector<double> frame_;
};

}  // namespace relative_map::core
