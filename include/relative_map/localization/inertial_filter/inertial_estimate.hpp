#pragma once

#include "relative_map/localization/geodesy/map_projection.hpp"
#include "relative_map/localization/inertial_filter/inertial_filter.hpp"
#include "relative_map/localization/pose_estimate.hpp"

namespace relative_map::core {

/// What the filter's state says of the body, in the map. Its stamp is the time at which the fixes' clock saw
/// it, where that shows the inertial sensor to be late: stamps can be late, but not early, so of two that
/// differ it is the later one that is put right.
PoseEstimate make_estimate(const InertialState& state, const InertialParam& param, const MapProjection& map);

}  // namespace relative_map::core
