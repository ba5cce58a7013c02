#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map {

/// The points of a message, without those that are not finite; `fault` is empty, or a sentence why there are
/// none: fields x y z missing or of a wrong type, or sizes that do not agree with the data. Intensity and
/// time
/// (`time`, `t`, `timestamp`, `offset_time`; integers in ns, real numbers in s) are taken where they are
/// there; times are counted from the message's stamp, absolute ones included.
core::PointCloud to_core(const sensor_msgs::PointCloud2& message, std::string& fault);

}  // namespace relative_map
