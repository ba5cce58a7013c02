#pragma once

#include <functional>
#include <vector>

#include "relative_map/tools/banded_program.hpp"
#include "relative_map/tools/editable_line.hpp"

namespace relative_map::core {

/// Without bends that are shorter than about six times `length` [m]: a smoothing spline through evenly spaced
/// points, `spacing` [m] apart. The ends of an open line are kept.
Polyline low_pass(const Polyline& points, Ends ends, double length, double spacing);

struct RoundParam {
  double bound;      ///< [m]
  double follow;     ///< [m]
  double stiffness;  ///< of the bound
};

/// One round of smoothing: from a reference of evenly spaced points, moves each along its normal so that
/// curvature changes least. `moved` becomes the farthest of those ways [m]. Empty if the numbers fail.
Polyline smoothing_round(const EditableLine& recorded, const Polyline& reference, const RoundParam& param,
                         const std::function<void()>& iterated, double& moved);

}  // namespace relative_map::core
