#pragma once

#include <relative_map/MapMsg.h>

#include <string>
#include <vector>

#include "relative_map/pipeline/contract/map_check.hpp"

namespace relative_map {

/// Rows of the contract that only a message can break: it says things twice.
std::vector<std::string> message_check_rows();

/// check_map for a published map, and the rows above. Any message may be given, from anywhere.
std::vector<core::Violation> check_message(const MapMsg& message, const core::MapContext& context);

}  // namespace relative_map
