#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/simulation/accuracy_metrics.hpp"
#include "relative_map/simulation/accuracy_scenes.hpp"

namespace relative_map::core {

/// Makes the maps of a drive, and measures them.
struct AccuracyMethod {
  std::string name;
  std::string fusion = "fixed_weight";  ///< LaneFusionParam::method
  bool deliver_markers = true;

  PipelineConfig config(LaneSource lane_source) const;
};

/// The published original's fusion, the lines alone, and the estimator; those that this build knows.
std::vector<AccuracyMethod> accuracy_methods();

struct MeasuredMap {
  double time = 0.0;  ///< [s] since the start of the drive
  MapErrors errors;
  std::size_t violations = 0;  ///< of the output contract
  std::string violation;       ///< the first one
  double cost = 0.0;           ///< [s] that its inputs and its tick took
};

/// Plays the drive into the pipeline that the node runs, and ticks it ten times a second. The first second,
/// in which there may be no map yet, is left out.
std::vector<MeasuredMap> map_drive(const RecordedDrive& drive, const PipelineConfig& config,
                                   bool deliver_markers);

/// Root mean square and 95th percentile of absolute values.
class ErrorStatistics {
 public:
  void add(double error) { errors_.push_back(error); }
  void add(const std::optional<double>& error) {
    if (error) add(*error);
  }
  void add(const ErrorStatistics& other) {
    errors_.insert(errors_.end(), other.errors_.begin(), other.errors_.end());
  }
  bool empty() const { return errors_.empty(); }
  std::size_t count() const { return errors_.size(); }
  // NaN if empty.
  double rms() const;
  double median() const { return percentile(0.5); }
  double percentile_95() const { return percentile(0.95); }

 private:
  double percentile(double share) const;

  std::vector<double> errors_;
};

/// All maps of a scene, or of a group of scenes, that one method made.
struct AccuracyRow {
  std::string scene, method;
  SceneGroup group = SceneGroup::kWithLine;
  std::array<ErrorStatistics, kErrorDistances.size()> center;  ///< [m]
  ErrorStatistics boundary, half_width, jitter_10, jitter_30;  ///< [m]
  ErrorStatistics heading;                                     ///< [rad]
  ErrorStatistics cost;                                        ///< [s] a map
  std::size_t usable = 0, usable_of = 0;                       ///< maps
  std::size_t violations = 0;
  std::string violation;  ///< the first one

  void add(const MeasuredMap& map);
  void add(const AccuracyRow& other);
};

struct BenchmarkOptions {
  std::uint64_t seeds = 3;
  ErrorLevel level;
  std::vector<std::string> scenes;   ///< none: all, if there are no `lines`
  std::vector<RecordedLine> lines;   ///< to be driven on, too
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
