#pragma once

#include <string>
#include <vector>

#include "relative_map/io/line_header.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// Navigation lines in files, as Apollo's tools write them (`.smoothed`): one JSON object a line with x, y
/// and, where known, z, s [m], theta [rad], kappa [1/m], dkappa [1/m^2], in the ENU map frame. The first
/// object may be a header (line_header.hpp), which readers that don't know it skip.
struct LineFile {
  LineHeader header;
  RecordedLine line;
  std::vector<std::string> notes = {};  ///< what was left out of the file or seems odd in it, a sentence each
};

/// Reads a line; its name is the file's without folder and extension, its priority 0. Keys that are missing
/// or null come back as NaN. Blank lines are skipped, and so is a first object without x and y that is not
/// this package's header. Objects may also share a line, with or without commas, be in an array, or be spread
/// over several lines.
/// Throws std::runtime_error, one sentence that names the file, the line and the fault, if the file cannot
/// be read or has no point, and for a line that is no JSON object, lacks x or y, or holds something that is
/// not a number.
LineFile read_line_file(const std::string& path);
RecordedLine read_navigation_line(const std::string& path);

enum class Layout {
  kOnePerLine,  ///< `.smoothed`
  kOneLine,     ///< the same objects as one JSON array
};

/// Writes a line's points, after the header unless it is empty; what is not finite is left out. The file
/// appears whole or not at all, see write_whole_file(). Throws std::runtime_error if that fails, or a point
/// lacks x or y.
void write_line_file(const std::string& path, const LineFile& file, Layout layout = Layout::kOnePerLine);
void write_navigation_line(const std::string& path, const RecordedLine& line);

/// Throws std::runtime_error, one sentence, for the first point whose x or y is not finite.
void expect_finite_positions(const std::string& path, const RecordedLine& line);

/// The file's name without folder and extension.
std::string line_name(const std::string& path);

}  // namespace relative_map::core
