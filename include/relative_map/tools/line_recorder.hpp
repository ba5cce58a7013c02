#pragma once

#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// A pose of the vehicle while a line is recorded, map frame.
struct RecordedPose {
  double stamp = 0.0;                ///< [s]
  double x = 0.0, y = 0.0, z = 0.0;  ///< [m]
  double heading = 0.0;              ///< [rad] counter-clockwise from east; NaN: not known
};

struct RecorderParam {
  double spacing = 0.5;         ///< [m] of the line's points
  double standing_speed = 0.5;  ///< [m/s] slower is standing still
  double max_jump = 50.0;       ///< [m] between poses that follow each other
};

/// A single pose that jumps away from those around it.
struct PoseOutlier {
  std::size_t pose = 0;   ///< which one
  double stamp = 0.0;     ///< [s]
  double distance = 0.0;  ///< [m] from where its neighbours put it
};

struct Recording {
  RecordedLine line;                  ///< x, y and z; the rest is not given
  std::vector<PoseOutlier> outliers;  ///< left out, as if they had not come
  std::size_t standing = 0;           ///< poses left out, since the vehicle stood
  std::size_t reversing = 0;          ///< poses while it reversed
  std::size_t taken_back = 0;         ///< points that it reversed over, and that were left out
  double noise = 0.0;                 ///< [m] standard deviation of a pose's x and y
  std::size_t moving = 0;             ///< poses while the vehicle moved
  std::size_t sideways = 0;           ///< of these, with a heading across the motion
  bool headings_used = true;          ///< to tell forward from back; false: too many lie across
  std::string fault;                  ///< a sentence if there is no line
};

/// The way that was driven forward, sampled by distance. Where the vehicle reverses, the line is taken back
/// to where it goes forward again. Neither noise nor drift of a receiver at rest is taken for motion.
/// `poses` in the order of their stamps, which may repeat.
Recording record_line(const std::vector<RecordedPose>& poses, const RecorderParam& param);

}  // namespace relative_map::core
