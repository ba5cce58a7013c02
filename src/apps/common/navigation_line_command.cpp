#include "navigation_line_command.hpp"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <iostream>
#include <sstream>

#include "navigation_line_bag.hpp"
#include "relative_map/io/whole_file.hpp"
#include "whole_bag.hpp"

namespace relative_map {

namespace {

bool is_number(const std::string& text) {
  char* end = nullptr;
  std::strtod(text.c_str(), &end);
  return !text.empty() && *end == '\0';
}

double parse_number(const std::string& option, const std::string& text) {
  if (!is_number(text)) throw UsageError(option + " must be a number, not '" + text + "'");
  return std::strtod(text.c_str(), nullptr);
}

core::LineFormat format_for(const std::string& path, const std::string& format) {
  const std::optional<core::LineFormat> known =
      format.empty() ? core::format_of(path) : core::parse_format(format);
  if (known) return *known;
  if (!format.empty())
    throw UsageError("'" + format + "' is no format: smoothed, one-line, csv, gpx, geojson, bag");
  throw UsageError(path +
                   ": its format is not known by its extension, which may be .smoothed, .json, .csv, .gpx, "
                   ".geojson or .bag");
}

bool is_bag(const std::string& path, const std::string& format) {
  return format.empty() ? std::filesystem::path(path).extension() == ".bag" : format == "bag";
}

}  // namespace

CommandLine::CommandLine(const std::vector<std::string>& words, const std::set<std::string>& options,
                         const std::set<std::string>& flags) {
  for (std::size_t i = 0; i < words.size(); ++i) {
    const std::string& word = words[i];
    if (options.count(word) > 0) {
      if (i + 1 == words.size()) throw UsageError(word + " lacks a value");
      values_[word] = words[++i];
    } else if (flags.count(word) > 0) {
      values_[word] = "";
    } else if (word.size() > 1 && word[0] == '-') {
      throw UsageError("unknown option " + word);
    } else {
      files_.push_back(word);
    }
  }
}

const std::vector<std::string>& CommandLine::files(std::size_t least, std::size_t most,
                                                   const std::string& names) const {
  if (files_.size() < least) throw UsageError(names + " must be named");
  if (files_.size() > most) throw UsageError("unexpected argument '" + files_[most] + "'");
  return files_;
}

std::string CommandLine::text(const std::string& option, const std::string& otherwise) const {
  const auto found = values_.find(option);
  return found == values_.end() ? otherwise : found->second;
}

double CommandLine::number(const std::string& option, double otherwise, double low, double high) const {
  if (!has(option)) return otherwise;
  const double number = parse_number(option, text(option));
  if (number >= low && number <= high) return number;
  std::ostringstream fault;
  fault << option << " is " << text(option) << ", but must lie in [" << low << ", " << high << "]";
  throw UsageError(fault.str());
}

std::vector<double> parse_numbers(const std::string& option, const std::string& text, std::size_t least,
                                  std::size_t most) {
  std::vector<double> numbers;
  std::istringstream stream(text);
  for (std::string word; std::getline(stream, word, ',');) numbers.push_back(parse_number(option, word));
  if (numbers.size() >= least && numbers.size() <= most) return numbers;
  throw UsageError(option + " must be " + std::to_string(least) + " to " + std::to_string(most) +
                   " numbers with commas between them, not '" + text + "'");
}

core::GeoReference reference_of(const CommandLine& line) {
  if (line.has("--utm") && line.has("--origin")) throw UsageError("--utm and --origin exclude each other");
  core::GeoReference reference;
  try {
    if (line.has("--utm")) reference = core::parse_utm_zone(line.text("--utm"));
  } catch (const std::runtime_error& fault) {
    throw UsageError(fault.what());
  }
  if (line.has("--origin")) {
    const std::vector<double> origin = parse_numbers("--origin", line.text("--origin"), 2, 3);
    reference.projection = core::Projection::kLocal;
    reference.latitude = origin[0];
    reference.longitude = origin[1];
    reference.altitude = origin.size() > 2 ? origin[2] : 0.0;
    if (!(std::abs(origin[0]) <= 90.0 && std::abs(origin[1]) <= 180.0)) {
      throw UsageError("--origin must be a latitude and a longitude in degrees, not '" +
                       line.text("--origin") + "'");
    }
  }
  return reference;
}

ProgressBar::ProgressBar() : shown_(isatty(STDERR_FILENO) != 0) {}

ProgressBar::~ProgressBar() {
  if (shown_ && last_percent_ >= 0) std::fputs("\n", stderr);
}

void ProgressBar::show(double done) {
  const int percent = static_cast<int>(100.0 * done);
  if (!shown_ || percent == last_percent_) return;
  last_percent_ = percent;
  const std::string bar(static_cast<std::size_t>(percent / 2), '#');
  std::fprintf(stderr, "\r[%-50s] %3d %%", bar.c_str(), percent);
}

core::LineFile load_line(const std::string& path, const std::string& format, const core::ReadOptions& options,
                         const std::string& topic) {
  if (is_bag(path, format)) return read_path_bag(path, topic);
  return core::read_line(path, format_for(path, format), options);
}

void save_line(const std::string& path, const core::LineFile& file, const std::string& format,
               const core::WriteOptions& options, const std::string& topic) {
  if (is_bag(path, format)) return write_path_bag(path, topic, file);
  core::write_line(path, format_for(path, format), file, options);
}

void expect_savable(const std::string& path, const std::string& format) {
  if (is_bag(path, format)) return expect_bag_writable(path);
  format_for(path, format);
  core::expect_writable(path);
}

void print_written(const std::string& path, const core::RecordedLine& line) {
  double length = 0.0;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    length += std::hypot(line.points[i].x - line.points[i - 1].x, line.points[i].y - line.points[i - 1].y);
  }
  std::printf("%s: %zu points, %.2f m\n", path.c_str(), line.points.size(), length);
}

}  // namespace relative_map
