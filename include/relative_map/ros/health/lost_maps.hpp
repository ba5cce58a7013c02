#pragma once

#include <relative_map/MapMsg.h>

#include <cstdint>

#include "relative_map/pipeline/contract/map_check.hpp"
#include "relative_map/pipeline/motion/stamp_order.hpp"
#include "relative_map/ros/messages/conversions.hpp"

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

/// Where the clock was set back, as when a recording begins anew, so are the stamps of maps: nothing that the
/// contract forbids.
inline void note_clock(const MapMsg& map, core::MapContext& context) {
  const core::Time stamp = to_core(map.header.stamp);
  if (context.previous_stamp && core::goes_back(*context.previous_stamp, stamp))
    context.previous_stamp.reset();
}

}  // namespace relative_map
