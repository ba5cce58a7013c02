#pragma once

#include <string>
#include <vector>

#include "relative_map/tools/line_recorder.hpp"

namespace relative_map::core {

/// A place in a drive where the stamps tell of another time than has passed.
struct ClockStep {
  std::size_t pose = 0;  ///< the first one after it
  double stamp = 0.0;    ///< [s] as it was given
  double step = 0.0;     ///< [s] that the clock was set forward by, or, negative, back; 0: it stood still
};

/// Poses in the order that they came in, with the times when they did, get stamps that never go back: where
/// the clock of the stamps was set, fell to another year or stood still, they go on by the time that passed.
/// Single poses that came late keep their stamps and are put in order. Without times nothing is known of
/// clocks, and all are put in order. The steps that were taken out.
std::vector<ClockStep> mend_clock(std::vector<RecordedPose>& poses);

/// Poses that come by turns from two places.
struct TwoSources {
  double from = 0.0, to = 0.0;  ///< [s] stamps
  double apart = 0.0;           ///< [m]
};

/// Poses by their stamps that lie on two ways by turns, as of two receivers on one topic, or of a drive whose
/// clock was set back and that is now woven into itself. Empty: there is no such stretch.
std::vector<TwoSources> find_two_sources(const std::vector<RecordedPose>& poses);

}  // namespace relative_map::core
