#pragma once

#include <cstdint>

#include "relative_map/model/inputs.hpp"
#include "relative_map/simulation/error_param.hpp"

namespace relative_map::core {

/// The line that is recorded where `truth` runs: its points are moved sideways, and only their positions are
/// given. Without errors it is `truth`. Throws std::invalid_argument if `truth` can't be driven on.
RecordedLine record_line(const RecordedLine& truth, const RecordingErrorParam& param, std::uint64_t seed);

}  // namespace relative_map::core
