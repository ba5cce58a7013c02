#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/inputs.hpp"
#include "relative_map/model/map.hpp"

namespace relative_map::core {

/// An input after its numbers were looked at: what can be repaired is, and each repair leaves a sentence that
/// names the topic, the field and the value. `refusal`: it can't be used at all.
template <class Input>
struct Checked {
  Input input;
  std::vector<std::string> remarks;
  std::optional<Status> refusal;
};

/// Of any link, as received. A direction that is given twice must be beyond doubt: heading and orientation
/// that disagree are refused, unless one of them was plainly never filled, or they differ by the 90 degrees
/// of the other orientation convention, where the heading holds.
Checked<Localization> check_localization(const Localization& link);

/// A speed that no car drives is not given (NaN).
Checked<Chassis> check_chassis(const Chassis& chassis);

/// A marker with a number that no camera reports is not seen: its quality becomes 0. A reach of more than
/// 300 m ahead or 50 m behind is taken as that. Two that are less than 1 m or more than 10 m apart leave a
/// remark only: one of them may be right. Whether paint is good enough to be used is not asked here.
Checked<LaneMarkers> check_lane_markers(const LaneMarkers& markers);

}  // namespace relative_map::core
