#pragma once

#include <Eigen/Geometry>
#include <string>
#include <vector>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core {

/// Where the sensor was, and when [s], on the same clock as the points' times.
struct TimedPose {
  double time = 0.0;
  Eigen::Isometry3d map_from_sensor = Eigen::Isometry3d::Identity();
};

/// The cloud as if all of it had been seen at `reference` [s]: each point is carried by the sensor's motion
/// between its own time and that. Between two poses the position is linear and the rotation spherical-linear;
/// up to `reach` [s] beyond the first and the last the nearest two go on.
/// `fault` is empty if it was done, else a sentence, and the cloud is what it was: without times, with fewer
/// than two poses or poses out of order, or with points farther than `reach` from all poses.
PointCloud deskewed(const PointCloud& cloud, const std::vector<TimedPose>& poses, double reference,
                    double reach, std::string& fault);

}  // namespace relative_map::core
