#include "relative_map/simulation/accuracy_report.hpp"

#include <cmath>
#include <iomanip>
#include <limits>
#include <locale>
#include <ostream>
#include <sstream>
#include <string>

#include "relative_map/geometry/angles.hpp"

namespace relative_map::core {

namespace {

constexpr int kNameWidth = 20, kMethodWidth = 13, kWidth = 7;

/// A cell, right-aligned; "-" where there is no figure.
std::string cell(double value, int digits = 3) {
  std::ostringstream text;
  text.imbue(std::locale::classic());
  text << std::setw(kWidth);
  if (std::isfinite(value)) {
    text << std::fixed << std::setprecision(digits) << value;
  } else {
    text << "-";
  }
  return text.str();
}

std::string cell(const std::string& title) {
  return std::string(static_cast<std::size_t>(kWidth) - title.size(), ' ') + title;
}

std::string padded(const std::string& text, int width) {
  std::ostringstream stream;
  stream << std::left << std::setw(width) << text << " ";
  return stream.str();
}

std::string names(const std::string& scene, const std::string& method) {
  return padded(scene, kNameWidth) + padded(method, kMethodWidth) + "|";
}

void print_head(std::ostream& out) {
  const auto block = static_cast<int>(kErrorDistances.size()) * kWidth - 1;
  std::string distances;
  for (const double distance : kErrorDistances) distances += cell(distance, 0);
  out << names("", "") << " " << padded("center, RMS [m] at [m] ahead", block) << "| "
      << padded("center, 95th percentile [m] at [m] ahead", block) << "|" << cell("border") << cell("width")
      << cell("head.") << " |" << cell("jitter") << cell("jitter") << " |" << cell("usable") << cell("contr.")
      << cell("cost") << "\n"
      << names("scene", "method") << distances << " |" << distances << " |" << cell("[m]") << cell("[m]")
      << cell("[deg]") << " |" << cell("10 [m]") << cell("30 [m]") << " |" << cell("[%]") << cell("viol.")
      << cell("[us]") << "\n";
}

void print_row(const AccuracyRow& row, std::ostream& out) {
  out << names(row.scene, row.method);
  for (const ErrorStatistics& error : row.center) out << cell(error.rms());
  out << " |";
  for (const ErrorStatistics& error : row.center) out << cell(error.percentile_95());
  out << " |" << cell(row.boundary.rms()) << cell(row.half_width.rms())
      << cell(row.heading.rms() * 180.0 / kPi) << " |" << cell(row.jitter_10.rms())
      << cell(row.jitter_30.rms()) << " |" << cell(100.0 * row.usable_share(), 2)
      << cell(static_cast<double>(row.violations), 0) << cell(1e6 * row.cost.median(), 0) << "\n";
}

/// Comma-separated, and empty where there is no figure.
class CsvLine {
 public:
  explicit CsvLine(std::ostream& out) : out_(out) { text_.imbue(std::locale::classic()); }
  ~CsvLine() { out_ << text_.str() << "\n"; }
  CsvLine& operator<<(const std::string& text) {
    text_ << separator() << text;
    return *this;
  }
  CsvLine& operator<<(double value) {
    text_ << separator();
    if (std::isfinite(value)) text_ << value;
    return *this;
  }
  CsvLine& operator<<(const std::optional<double>& value) {
    return *this << value.value_or(std::numeric_limits<double>::quiet_NaN());
  }

 private:
  const char* separator() {
    const bool first = first_;
    first_ = false;
    return first ? "" : ",";
  }

  std::ostream& out_;
  std::ostringstream text_;
  bool first_ = true;
};

void add_distances(const std::string& name, CsvLine& line) {
  for (const double distance : kErrorDistances) line << name + std::to_string(std::lround(distance)) + "_m";
}

}  // namespace

void print_table(const BenchmarkResult& result, std::ostream& out) {
  print_head(out);
  for (const AccuracyRow& row : result.rows) print_row(row, out);
  out << "\n";
  for (const AccuracyRow& row : result.totals) print_row(row, out);
}

void write_table(const BenchmarkResult& result, std::ostream& out) {
  {
    CsvLine head(out);
    head << "scene"
         << "method";
    add_distances("center_rms_at_", head);
    add_distances("center_95_at_", head);
    head << "boundary"
         << "half_width"
         << "heading"
         << "jitter_10"
         << "jitter_30"
         << "usable"
         << "violations"
         << "cost"
         << "consistent"
         << "worst_second"
         << "painted"
         << "markers_alone";
  }
  for (const std::vector<AccuracyRow>* rows : {&result.rows, &result.totals}) {
    for (const AccuracyRow& row : *rows) {
      CsvLine line(out);
      line << row.scene << row.method;
      for (const ErrorStatistics& error : row.center) line << error.rms();
      for (const ErrorStatistics& error : row.center) line << error.percentile_95();
      line << row.boundary.rms() << row.half_width.rms() << row.heading.rms() << row.jitter_10.rms()
           << row.jitter_30.rms() << row.usable_share() << static_cast<double>(row.violations)
           << row.cost.median() << row.consistent_share() << row.worst_second << row.painted_share()
           << (row.group == SceneGroup::kMarkersAlone ? 1.0 : 0.0);
    }
  }
}

void write_maps_header(std::ostream& out) {
  CsvLine head(out);
  head << "scene"
       << "seed"
       << "method"
       << "time";
  add_distances("center_at_", head);
  head << "left_boundary"
       << "right_boundary"
       << "left_half_width"
       << "right_half_width"
       << "heading"
       << "jitter_10"
       << "jitter_30"
       << "usable"
       << "violations"
       << "beside"
       << "claimed"
       << "markers_alone";
}

void write_maps(const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                const std::vector<MeasuredMap>& maps, std::ostream& out) {
  for (const MeasuredMap& map : maps) {
    const MapErrors& errors = map.errors;
    CsvLine line(out);
    line << scene.name << static_cast<double>(seed) << method.name << map.time;
    for (const std::optional<double>& error : errors.center) line << error;
    line << errors.left_boundary << errors.right_boundary << errors.left_half_width << errors.right_half_width
         << errors.heading << errors.jitter_10 << errors.jitter_30;
    line << (errors.usable ? std::optional<double>(*errors.usable ? 1.0 : 0.0) : std::nullopt)
         << static_cast<double>(map.violations) << errors.beside
         << (map.claimed > 0.0 ? std::optional<double>(map.claimed) : std::nullopt)
         << (scene.group == SceneGroup::kMarkersAlone ? 1.0 : 0.0);
  }
}

}  // namespace relative_map::core
