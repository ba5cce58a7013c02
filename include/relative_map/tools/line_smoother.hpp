#pragma once

#include <functional>
#include <optional>
#include <string>

#include "relative_map/tools/editable_line.hpp"

namespace relative_map::core {

struct SmootherParam {
  double bound = 0.25;          ///< [m] the recorded points lie no farther beside the result
  double spacing = 0.5;         ///< [m] of the result's points
  double follow = 30.0;         ///< [m] bends longer than about six of these follow the recording
  double max_curvature = 0.25;  ///< [1/m] that the vehicle can drive
};

struct SmoothedLine {
  EditableLine line;
  double length = 0.0;              ///< [m]
  double greatest_deviation = 0.0;  ///< [m] between the recording and the result, either way
  double deviation_s = 0.0;         ///< [m] along the result, where that is; the same below
  double greatest_kappa = 0.0;      ///< [1/m]
  double kappa_s = 0.0;
  double greatest_dkappa = 0.0;  ///< [1/m^2]
  double dkappa_s = 0.0;
  double longest_gap = 0.0;  ///< [m] between recorded points: there the line is a guess
  double gap_s = 0.0;
  std::string fault;  ///< a sentence if the result can't be used: it says where
};

/// The line of least curvature change, the integral of dkappa^2, that stays within `bound` of the recorded
/// points. Bends much longer than `follow` lie where they were recorded, and not at the bound. The ends of an
/// open line stay where they are, and a closed one stays closed and smooth across its seam. `progress` is
/// called with the share that is done, [0, 1].
SmoothedLine smooth_line(const EditableLine& recorded, const SmootherParam& param,
                         const std::function<void(double)>& progress);

/// Where smooth_line() has a fault: a bound and a `follow` with which it has none, tried; none: even with
/// `max_bound` [m] it has one.
std::optional<SmootherParam> find_feasible(const EditableLine& recorded, const SmootherParam& param,
                                           double max_bound, const std::function<void(double)>& progress);

}  // namespace relative_map::core
