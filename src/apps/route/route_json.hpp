#pragma once

#include <nlohmann/json.hpp>

#include "relative_map/model/route_segments.hpp"
#include "relative_map/route/reference_line.hpp"
#include "relative_map/route/route_index.hpp"

namespace relative_map {

/// What a tick gives, as one JSON object: the place and the segments, or {"refused": why}. `index` is the
/// route's; none where it was made from a relative map.
nlohmann::json json_of(const core::RouteUpdate& update, const core::RouteIndex* index);

/// [[x, y, theta, kappa, s]...]
nlohmann::json json_of(const core::ReferenceLine& line);

/// "FORWARD", "LEFT", "RIGHT".
const char* name_of(core::ChangeLane change);

/// A number to a thousandth of a millimetre, without -0.
double rounded(double value);

}  // namespace relative_map
