#pragma once

#include <string>

#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// Navigation lines in files, as Apollo's tools write them (`.smoothed`): one JSON object a line with x, y
/// and, where known, z, s [m], theta [rad], kappa [1/m], dkappa [1/m^2], in the ENU map frame.

/// Reads a line; its name is the file's without folder and extension, its priority 0. Keys that are missing
/// or null come back as NaN. Blank lines are skipped, and so is a first object without x and y (a header).
/// Throws std::runtime_error, one sentence that names the file, the line and the fault, if the file cannot
/// be read or has no point, and for a line that is no JSON object, lacks x or y, or holds something that is
/// not a number.
RecordedLine read_navigation_line(const std::string& path);

/// Writes a line's points; what is not finite is left out. The file appears whole or not at all: a temporary
/// file beside it is renamed into place. Throws std::runtime_error if that fails, or a point lacks x or y.
void write_navigation_line(const std::string& path, const RecordedLine& line);

}  // namespace relative_map::core
