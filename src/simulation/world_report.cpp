#include "relative_map/simulation/world_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

namespace relative_map::core {

namespace {

constexpr std::size_t kAt10 = 2, kAt30 = 4;  // of kErrorDistances
constexpr double kWorse = 0.01;              // [m] by which what is simpler may be better
constexpr double kHonest = 0.99;             // share within three standard deviations

/// As printf does.
template <class... Values>
std::string text(const char* format, Values... values) {
  char buffer[256];
  std::snprintf(buffer, sizeof buffer, format, values...);
  return buffer;
}

const AccuracyRow* find(const BenchmarkResult& result, const std::string& scene, const std::string& method,
                        bool markers_alone) {
  const auto found = std::find_if(result.rows.begin(), result.rows.end(), [&](const AccuracyRow& row) {
    return row.scene == scene && row.method == method &&
           (row.group == SceneGroup::kMarkersAlone) == markers_alone;
  });
  return found == result.rows.end() ? nullptr : &*found;
}

std::string errors_of(const AccuracyRow* row) {
  if (row == nullptr) return "     -     -      - ";
  return text(" %5.3f %5.3f %6.2f ", row->center[kAt10].rms(), row->center[kAt30].rms(),
              100.0 * row->usable_share());
}

std::string trust_of(const AccuracyRow* row) {
  if (row == nullptr) return "     -     -      - ";
  const std::string consistent =
      row->consistent_of == 0 ? "     -" : text("%6.2f", 100.0 * row->consistent_share());
  return consistent + text(" %5.2f %6.1f ", row->worst_second, 100.0 * row->painted_share());
}

bool worse(const AccuracyRow* row, const AccuracyRow* other) {
  if (row == nullptr || other == nullptr) return false;
  return row->center[kAt10].rms() > other->center[kAt10].rms() + kWorse ||
         row->center[kAt30].rms() > other->center[kAt30].rms() + kWorse;
}

/// How the methods do in one world.
struct WorldRows {
  const AccuracyRow *estimator, *line, *filter, *alone, *filter_alone;
};

/// What is not as it should be.
std::string verdict_of(const WorldRows& rows) {
  std::string verdict;
  const auto add = [&](bool fault, const char* name) {
    if (fault) verdict += (verdict.empty() ? "" : ", ") + std::string(name);
  };
  const auto broken = [](const AccuracyRow* row) { return row != nullptr && row->violations > 0; };
  const auto too_sure = [](const AccuracyRow* row) {
    return row != nullptr && row->consistent_share() < kHonest;
  };
  add(worse(rows.estimator, rows.line), "worse than the line");
  add(worse(rows.estimator, rows.filter), "than the filter");
  add(too_sure(rows.estimator), "too sure");
  add(worse(rows.alone, rows.filter_alone), "alone worse than the filter");
  add(too_sure(rows.alone), "too sure alone");
  add(broken(rows.estimator) || broken(rows.alone), "breaks the contract");
  return verdict;
}

}  // namespace

void print_worlds(const BenchmarkResult& result, std::ostream& out) {
  const std::string errors = "  10 m  30 m usable ", trust = " in 3s worst  paint ",
                    error_units = "   [m]   [m]    [%] ", trust_units = "   [%]   [m]    [%] ";
  const auto head = [&](const char* name, const std::string& first, const std::string& second) {
    out << text("%-21s|", name) << first << second << "|" << first << "|" << first << "|" << first << second
        << "|" << first << "|\n";
  };
  out << text("%-21s|%-40s|%-20s|%-20s|%-40s|%-20s|\n", "", " estimator", " line alone", " 4-state filter",
              " estimator, markers alone", " filter, alone");
  head("world", errors, trust);
  head("", error_units, trust_units);
  std::string last;
  for (const AccuracyRow& row : result.rows) {
    if (row.scene == last) continue;
    last = row.scene;
    const WorldRows rows = {find(result, last, "estimator", false), find(result, last, "line", false),
                            find(result, last, "filter", false), find(result, last, "estimator", true),
                            find(result, last, "filter", true)};
    out << text("%-21s|", last.c_str()) << errors_of(rows.estimator) << trust_of(rows.estimator) << "|"
        << errors_of(rows.line) << "|" << errors_of(rows.filter) << "|" << errors_of(rows.alone)
        << trust_of(rows.alone) << "|" << errors_of(rows.filter_alone) << "| " << verdict_of(rows) << "\n";
  }
}

void print_drive(const AccuracyScene& scene, std::uint64_t seed, const AccuracyMethod& method,
                 const std::vector<MeasuredMap>& maps, double period, std::ostream& out) {
  out << scene.name << ", drive " << seed << ", " << method.name
      << (scene.lane_source == LaneSource::kPerception ? ", markers alone" : "") << "\n";
  double next = 0.0;
  for (const MeasuredMap& map : maps) {
    if (map.time < next - 1e-6 || !map.errors.center[0]) continue;
    next = map.time + period;
    const auto error = [&](std::size_t i) { return map.errors.center[i].value_or(NAN); };
    out << text("%7.1f s  at 0 / 10 / 30 m: %6.2f %6.2f %6.2f  claimed %5.2f %s%s  ", map.time,
                map.errors.beside.value_or(NAN), error(kAt10), error(kAt30), map.claimed,
                map.errors.usable.value_or(true) ? " " : "!",
                map.errors.consistent.value_or(true) ? " " : "*")
        << map.remarks.substr(0, 160) << "\n";
  }
}

}  // namespace relative_map::core
