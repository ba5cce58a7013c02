#pragma once

#include <Eigen/Geometry>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core {

/// The points that are no nearer than `nearest` [m] to the origin and no farther than `farthest` [m]: the
/// vehicle's own body goes, and what is too far for its beam to tell much. Points that are not finite go,
/// too.
PointCloud crop(const PointCloud& cloud, double nearest, double farthest);

/// One point for each voxel of edge `leaf` [m] that has any: the means of place, intensity and time. In the
/// order in which the voxels were first met. `leaf` <= 0 leaves the cloud as it is. Points that are not
/// finite are left out, and those a million leaves and more from the first.
PointCloud voxel_filter(const PointCloud& cloud, double leaf);

PointCloud transformed(const PointCloud& cloud, const Eigen::Isometry3d& target_from_source);

}  // namespace relative_map::core
