#pragma once

#include <vector>

#include "relative_map/tools/line_recorder.hpp"

namespace relative_map::core {

/// Single poses that jump away and back, farther than noise or a vehicle would, by rising stamp.
std::vector<PoseOutlier> find_outliers(const std::vector<RecordedPose>& poses);

/// [m] that the poses before one usually deviate from where their neighbours put them, or those from it on:
/// the greater of the two.
double usual_deviation(const std::vector<RecordedPose>& poses, std::size_t pose);

std::vector<RecordedPose> without(const std::vector<RecordedPose>& poses,
                                  const std::vector<PoseOutlier>& outliers);

}  // namespace relative_map::core
