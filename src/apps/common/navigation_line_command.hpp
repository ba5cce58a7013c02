#pragma once

#include <map>
#include <string>
#include <vector>

#include "command_line.hpp"
#include "relative_map/io/line_formats.hpp"
#include "relative_map/tools/editable_line.hpp"

namespace relative_map {

/// Where coordinates of the earth are projected to: --utm ZONE or --origin LAT,LON[,ALT]; else nowhere yet.
core::GeoReference reference_of(const CommandLine& line);

/// Any format by its extension, or as `format` says (empty: by the extension); .bag holds a nav_msgs/Path.
/// What a reader has noticed, and nobody may miss, goes to stderr.
core::LineFile load_line(const std::string& path, const std::string& format = "",
                         const core::ReadOptions& options = {}, const std::string& topic = "");
void save_line(const std::string& path, const core::LineFile& file, const std::string& format = "",
               const core::WriteOptions& options = {}, const std::string& topic = "");

/// Throws what save_line() would for a path that can't be written to, that is one of `inputs`, or whose
/// format is not known: before the work, and not after it.
void expect_savable(const std::string& path, const std::vector<std::string>& inputs,
                    const std::string& format = "", const std::string& topic = "");

/// Says that a file may be replaced that was read from, or may be meant to be read.
constexpr const char* kReplace = "--replace";
inline bool may_replace(const CommandLine& line) {
  return line.has(kReplace);
}

/// "PATH: N points, L m", for every line that is written.
void print_written(const std::string& path, const core::RecordedLine& line);

/// What a person reads of a subcommand, and what runs it. It gives the exit code.
struct Command {
  const char* name;
  const char* summary;
  const char* help;
  int (*run)(const std::vector<std::string>& words, const std::map<std::string, std::string>& remappings);
};

extern const Command kRecord, kSmooth, kConvert, kResample, kClose, kOffset, kReverse, kCut, kJoin, kCheck,
    kPublish;

}  // namespace relative_map
