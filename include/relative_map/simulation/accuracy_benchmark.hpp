#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "relative_map/simulation/accuracy_row.hpp"
#include "relative_map/simulation/drive_mapping.hpp"

namespace relative_map::core {

struct BenchmarkOptions {
  std::uint64_t seeds = 3;
  ErrorLevel level;
  std::vector<std::string> scenes;   ///< none: all, if there are no `lines` and `worlds`
  std::vector<RecordedLine> lines;   ///< to be driven on, too
  std::vector<std::string> worlds;   ///< to be driven in, too
  bool markers_alone = false;        ///< the worlds' drives without their lines, too
  std::vector<std::string> methods;  ///< none: all
};

struct BenchmarkResult {
  std::vector<AccuracyRow> rows;    ///< by scene, then method
  std::vector<AccuracyRow> totals;  ///< by group, then method: all maps of its scenes together
  double driven = 0.0;              ///< [s] simulated
  double mapped = 0.0;              ///< [s] driven, times the methods that mapped it
  double simulation_time = 0.0, mapping_time = 0.0;  ///< [s] that it took
};

/// Told of each scene, seed and method that is done.
using DriveObserver = std::function<void(const AccuracyScene& scene, std::uint64_t seed,
                                         const AccuracyMethod& method, const std::vector<MeasuredMap>& maps)>;

/// Throws std::invalid_argument at a scene or method that there is not.
BenchmarkResult run_benchmark(const BenchmarkOptions& options, const DriveObserver& observer = {});

}  // namespace relative_map::core
