#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/motion/heading_witness.hpp"

namespace relative_map::core {

/// An input after its numbers were looked at: what can be repaired is, and each repair leaves a sentence that
/// names the topic, the field and the value. `refusal`: it can't be used at all.
template <class Input>
struct Checked {
  Input input;
  std::vector<std::string> remarks;
  std::optional<Status> refusal;
};

/// Of any link, as received, but for which of its directions holds. Refused where the localization itself
/// says that it has failed. A heading that is no angle in radians is not given (NaN) afterwards, an
/// orientation that is none is zero, and others are of unit length.
Checked<Localization> check_numbers(const Localization& link);

/// Which of heading and orientation holds, by what motion says of them, and turned by the offset from the
/// course that it is sure of. A direction that the motion contradicts is refused, with its likely cause. Two
/// that disagree: the one that the motion bears out; before it tells, they are refused, unless one of them
/// was plainly never filled, or they differ by the 90 degrees of the other orientation convention, where the
/// heading holds. An orientation that is exactly the identity, beside no heading, was never filled: no
/// direction is given. The heading is NaN afterwards where the orientation holds.
void settle_direction(const MotionEvidence& motion, Checked<Localization>& checked);

/// Both, of a single message: without what motion says.
Checked<Localization> check_localization(const Localization& link);

/// A speed that no car drives is not given (NaN).
Checked<Chassis> check_chassis(const Chassis& chassis);

/// A marker with a number that no camera reports is not seen: its quality becomes 0. A reach of more than
/// 300 m ahead or 50 m behind is taken as that. Two that are less than 1 m or more than 10 m apart leave a
/// remark only: one of them may be right. Whether paint is good enough to be used is not asked here.
Checked<LaneMarkers> check_lane_markers(const LaneMarkers& markers);

}  // namespace relative_map::core
