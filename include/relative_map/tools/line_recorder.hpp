#pragma once

#include <limits>
#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A pose of the vehicle while a line is recorded, map frame.
struct RecordedPose {
  double stamp = 0.0;                ///< [s]
  double x = 0.0, y = 0.0, z = 0.0;  ///< [m]
  double heading = 0.0;              ///< [rad] counter-clockwise from east; NaN: not known
  double received = std::numeric_limits<double>::quiet_NaN();  ///< [s] by another clock; NaN: not known
  /// [m] standard deviation of x and y, as whoever measured it states; NaN: not stated
  double deviation = std::numeric_limits<double>::quiet_NaN();
};

struct RecorderParam {
  double spacing = 0.5;         ///< [m] of the line's points
  double standing_speed = 0.5;  ///< [m/s] slower is standing still
  double max_jump = 50.0;       ///< [m] between poses that follow each other, where no car is that fast
  /// [m] standard deviation of a pose that can be a line's: worse ones would not tell the lane from the next
  double max_noise = 5.0;
};

/// A single pose that jumps away from those around it.
struct PoseOutlier {
  std::size_t pose = 0;   ///< which one
  double stamp = 0.0;     ///< [s]
  double distance = 0.0;  ///< [m] from where its neighbours put it
};

/// What became of the way that was driven [m], as far as noise lets its length be known.
struct WayShares {
  double kept = 0.0;  ///< is in the line
  double lost =
      0.0;  ///< is not, though it was driven forward: poses were missing, too bad, or hidden by noise
  double reversed = 0.0;  ///< was driven in reverse

  double share() const { return kept + lost > 0.0 ? kept / (kept + lost) : 1.0; }
};

struct Recording {
  RecordedLine line;                  ///< x, y and z; the rest is not given
  std::vector<PoseOutlier> outliers;  ///< left out, as if they had not come
  std::size_t doubtful = 0;           ///< left out likewise: stated to be worse than max_noise
  std::size_t scattered = 0;          ///< poses that scatter by more than max_noise, no points of the line
  std::size_t standing = 0;           ///< poses left out, since the vehicle stood
  std::size_t reversing = 0;          ///< poses while it reversed
  std::size_t taken_back = 0;         ///< points that it reversed over, and that were left out
  double noise = 0.0;                 ///< [m] standard deviation of a pose's x and y, from pose to pose
  std::size_t moving = 0;             ///< poses while the vehicle moved
  std::size_t sideways = 0;           ///< of these, with a heading across the motion
  bool headings_used = true;          ///< to tell forward from back; false: too many lie across
  WayShares way;
  std::string fault;  ///< a sentence if there is no line
};

/// The way that was driven forward, sampled by distance. Where the vehicle reverses, the line is taken back
/// to where it goes forward again. Neither noise nor drift of a receiver at rest is taken for motion; motion
/// that noise hides is looked for over longer times. There is no line if less than half of the way can be
/// kept, or if the poses come by turns from two sources. `poses` in the order of their stamps, which may
/// repeat: see mend_clock().
Recording record_line(const std::vector<RecordedPose>& poses, const RecorderParam& param);

}  // namespace relative_map::core
