#pragma once

#include <vector>

#include "relative_map/tools/line_recorder.hpp"

namespace relative_map::core {

/// Single poses that jump away and back, farther than noise or a vehicle would, by rising stamp.
std::vector<PoseOutlier> find_outliers(const std::vector<RecordedPose>& poses);

std::vector<RecordedPose> without(const std::vector<RecordedPose>& poses,
                                  const std::vector<PoseOutlier>& outliers);

}  // namespace relative_map::core
