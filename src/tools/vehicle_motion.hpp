#pragma once

#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/tools/line_recorder.hpp"

namespace relative_map::core {

enum class Motion { kStanding, kForward, kReversing };

/// How the vehicle moves at a pose, from the poses around it.
struct PoseMotion {
  Motion motion = Motion::kStanding;
  Point2 position = Point2::Zero();    ///< [m] relative to the first pose, with less noise than the pose
  Point2 direction = Point2::UnitX();  ///< unit vector of the travel, backward where it reverses
  double noise = 0.0;                  ///< [m] standard deviation of the poses' x and y around here
  double deviation = 0.0;              ///< [m] standard deviation of `position` by that
};

struct VehicleMotion {
  std::vector<PoseMotion> poses;  ///< one a pose
  double noise = 0.0;             ///< [m] standard deviation of a pose's x and y, as is usual among the poses
  std::size_t moving = 0;         ///< poses
  std::size_t sideways = 0;       ///< moving poses whose heading lies across the motion
  bool headings_used = true;      ///< false: too many lie across
};

/// Motion is faster than `standing_speed` [m/s] and than noise seems to be, and leads somewhere; it is taken
/// from the poses within `window` [s] before and after. Forward and back are told apart by headings, where
/// these make sense; else the vehicle goes forward at first, and reverses where its way turns about at once.
/// `poses` are finite, and in the order of their stamps.
VehicleMotion find_motion(const std::vector<RecordedPose>& poses, double standing_speed, double window = 1.0);

}  // namespace relative_map::core
