#pragma once

#include <vector>

#include "relative_map/tools/editable_line.hpp"

namespace relative_map::core {

// Each makes a new line of a line, whose z goes along. What can't be done is thrown as std::runtime_error,
// one sentence that says where. s is the arc length [m] from the line's first point.

/// Evenly spaced, about `spacing` [m] apart, on cubics through the points. The ends are kept.
EditableLine resample(const EditableLine& line, double spacing);

/// Spacing [m] where the curvature [1/m] is above a threshold.
struct CurvatureSpacing {
  double above_curvature;
  double spacing;
};
/// 3.0, 1.0, 0.4, 0.1 m above 0, 0.002, 0.008, 0.02 1/m.
std::vector<CurvatureSpacing> default_curvature_spacing();
/// The steeper the curve ahead, the nearer its points; `steps` by rising curvature, from 0. The ends are
/// kept.
EditableLine resample_by_curvature(const EditableLine& line, const std::vector<CurvatureSpacing>& steps);

/// The parallel at `distance` [m], left positive. Throws where the curve's centre is nearer than that, since
/// the parallel would fold there, and where the line comes so near to itself that the parallel would cross
/// itself and the line does not.
EditableLine offset(const EditableLine& line, double distance);

/// A lap of a line that comes back to its start: what goes on beyond it is left out, a gap of up to
/// `max_gap` [m] is bridged, and an error sideways of up to that is spread over the last 50 m.
EditableLine close(const EditableLine& line, double max_gap);

EditableLine reverse(const EditableLine& line);

/// From s to s; on a closed line it may lead across the start, from the greater to the smaller.
EditableLine cut(const EditableLine& line, double from, double to);

/// One line of several, in their order: each must start no farther than `max_gap` [m] from the end of the one
/// before and go on in its direction; where they overlap, the earlier one is taken.
EditableLine join(const std::vector<EditableLine>& lines, double max_gap);

}  // namespace relative_map::core
