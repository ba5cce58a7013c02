#pragma once

#include <vector>

#include "relative_map/io/navigation_line_file.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// The steps of a line from point to point that are longer than `max_gap` [m]: nothing was recorded there.
std::vector<BridgedGap> gaps_of(const RecordedLine& line, double max_gap);

/// These, and those that are bridged already.
std::vector<BridgedGap> all_gaps(const LineFile& file, double max_gap);

/// [m] that a gap's ends may lie from a line that was smoothed or resampled.
constexpr double kBesideGap = 15.0;

/// Those of `gaps` that `edited`, which was made of the line, has points across, where it has them: a step
/// that is still as open as before shows by itself, and what was cut out is no gap any more. Points of
/// `edited` lie up to `beside` [m] beside those that they were made of.
std::vector<BridgedGap> still_bridged(const std::vector<BridgedGap>& gaps, const RecordedLine& edited,
                                      double beside);

/// The point of a line that is nearest to a place.
std::size_t nearest_point(const RecordedLine& line, double x, double y);

double length_of(const BridgedGap& gap);

}  // namespace relative_map::core
