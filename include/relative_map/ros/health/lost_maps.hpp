#pragma once

#include <relative_map/MapMsg.h>

#include <cstdint>

#include "relative_map/pipeline/contract/map_check.hpp"

namespace relative_map {

/// How many maps got lost on the way before this one, as its number tells: a fault of queue, network or
/// recorder and not of the map, so that `context` takes the number before as seen.
inline std::size_t note_lost(const MapMsg& map, core::MapContext& context) {
  if (!context.previous_sequence_num) return 0;
  const std::uint32_t step = map.sequence_num - *context.previous_sequence_num;
  // What seems to leap by half of all numbers has gone back.
  if (step < 2 || step > 0x7fffffffU) return 0;
  context.previous_sequence_num = map.sequence_num - 1;
  return step - 1;
}

}  // namespace relative_map
