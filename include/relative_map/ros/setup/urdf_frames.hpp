#pragma once

#include <tf2/buffer_core.h>

#include <string>

namespace relative_map {

/// Adds how the links of a robot description lie to each other; joints that move, at rest. Throws
/// std::runtime_error, one sentence, if it is no URDF.
void add_urdf_frames(const std::string& urdf, tf2::BufferCore& transforms);

}  // namespace relative_map
