#include "relative_map/simulation/world_report.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ostream>
#include <string>

namespace relative_map::core {

namespace {

constexpr std::size_t kAt10 = 2, kAt30 = 4;  // of kErrorDistances
constexpr double kWorse = 0.01;              // [m] by which the line alone may be better

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
  if (row == nullptr) return "    -     -      -  ";
  return text("%5.3f %5.3f %6.2f ", row->center[kAt10].rms(), row->center[kAt30].rms(),
              100.0 * row->usable_share());
}

std::string trust_of(const AccuracyRow* row) {
  if (row == nullptr) return "    -      -     -  ";
  const std::string consistent =
      row->consistent_of == 0 ? "    - " : text("%6.2f", 100.0 * row->consistent_share());
  return consistent + text(" %5.2f %6.1f ", row->worst_second, 100.0 * row->painted_share());
}

/// What is not as it should be.
std::string verdict_of(const AccuracyRow* estimator, const AccuracyRow* line, const AccuracyRow* alone) {
  std::string verdict;
  const auto add = [&](bool fault, const char* name) {
    if (fault) verdict += (verdict.empty() ? "" : ", ") + std::string(name);
  };
  if (estimator != nullptr && line != nullptr) {
    add(estimator->center[kAt10].rms() > line->center[kAt10].rms() + kWorse ||
            estimator->center[kAt30].rms() > line->center[kAt30].rms() + kWorse,
        "worse than the line");
  }
  add(estimator != nullptr && estimator->consistent_share() < 0.99, "too sure");
  add(alone != nullptr && alone->consistent_share() < 0.99, "too sure alone");
  add((estimator != nullptr && estimator->violations > 0) || (alone != nullptr && alone->violations > 0),
      "breaks the contract");
  return verdict;
}

}  // namespace

void print_worlds(const BenchmarkResult& result, std::ostream& out) {
  out << text("%-21s|%-40s|%-20s|%-40s|\n", "", " estimator", " line alone", " markers alone")
      << text("%-21s|", "world") << "  10 m  30 m usable  in 3s worst  paint |  10 m  30 m usable |"
      << "  10 m  30 m usable  in 3s worst  paint |\n"
      << text("%-21s|", "") << "   [m]   [m]    [%]    [%]   [m]    [%] |   [m]   [m]    [%] |"
      << "   [m]   [m]    [%]    [%]   [m]    [%] |\n";
  std::string last;
  for (const AccuracyRow& row : result.rows) {
    if (row.scene == last) continue;
    last = row.scene;
    const AccuracyRow *estimator = find(result, last, "estimator", false),
                      *line = find(result, last, "line", false),
                      *alone = find(result, last, "estimator", true);
    out << text("%-21s| ", last.c_str()) << errors_of(estimator) << trust_of(estimator) << "| "
        << errors_of(line) << "| " << errors_of(alone) << trust_of(alone) << "| "
        << verdict_of(estimator, line, alone) << "\n";
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
