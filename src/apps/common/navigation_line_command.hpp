#pragma once

#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "relative_map/io/line_formats.hpp"
#include "relative_map/tools/editable_line.hpp"

namespace relative_map {

/// A call that can't be carried out as it was written.
struct UsageError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The words of a subcommand: files, "--option value" and "--flag". Everything throws UsageError, a sentence.
class CommandLine {
 public:
  CommandLine(const std::vector<std::string>& words, const std::set<std::string>& options,
              const std::set<std::string>& flags = {});

  const std::vector<std::string>& files() const { return files_; }
  /// The files, if there are so many; `names` is for the sentence, e.g. "IN and OUT".
  const std::vector<std::string>& files(std::size_t least, std::size_t most, const std::string& names) const;
  bool has(const std::string& name) const { return values_.count(name) > 0; }
  std::string text(const std::string& option, const std::string& otherwise = "") const;
  double number(const std::string& option, double otherwise, double low, double high) const;

 private:
  std::vector<std::string> files_;
  std::map<std::string, std::string> values_;
};

/// "48.1,11.5[,520]" or such, `least` to `most` of them.
std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most);

/// Where coordinates of the earth are projected to: --utm ZONE or --origin LAT,LON[,ALT]; else nowhere yet.
core::GeoReference reference_of(const CommandLine& line);

/// A bar on a terminal; silent elsewhere.
class ProgressBar {
 public:
  ProgressBar();
  ~ProgressBar();
  /// `done`: the share, [0, 1].
  void show(double done);

 private:
  bool shown_;
  int last_percent_ = -1;
};

/// Any format by its extension, or as `format` says (empty: by the extension); .bag holds a nav_msgs/Path.
core::LineFile load_line(const std::string& path, const std::string& format = "",
                         const core::ReadOptions& options = {}, const std::string& topic = "");
void save_line(const std::string& path, const core::LineFile& file, const std::string& format = "",
               const core::WriteOptions& options = {}, const std::string& topic = "");

/// Throws what save_line() would for a path that can't be written to, or whose format is not known: before
/// the work, and not after it.
void expect_savable(const std::string& path, const std::string& format = "");

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
