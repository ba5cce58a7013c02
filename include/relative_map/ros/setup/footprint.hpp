#pragma once

#include <string>

#include "relative_map/model/config.hpp"

namespace relative_map {

/// The box around all collision primitives (boxes, cylinders, spheres) of a robot description whose joints
/// between `base_frame` and them are fixed; half width is the wider side's.
/// A tf prefix of `base_frame` (car1/base_link) need not be in the description.
/// Throws std::runtime_error with one sentence: no valid URDF, no such link, no collision primitive.
core::Footprint footprint_from_urdf(const std::string& urdf, const std::string& base_frame);

}  // namespace relative_map
