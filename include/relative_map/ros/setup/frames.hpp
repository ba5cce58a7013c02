#pragma once

#include <tf2/buffer_core.h>

#include <Eigen/Geometry>
#include <functional>
#include <optional>
#include <string>

namespace relative_map {

/// target_from_source between two links of the vehicle, or none if it is not known.
using LinkTransforms =
    std::function<std::optional<Eigen::Isometry3d>(const std::string& target, const std::string& source)>;

/// Looks links up in `buffer`, which must outlive the result. Identity where target is source.
LinkTransforms link_transforms(const tf2::BufferCore& buffer);

}  // namespace relative_map
