#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/simulation/accuracy_metrics.hpp"
#include "relative_map/simulation/accuracy_scenes.hpp"

namespace relative_map::core {

struct MeasuredMap {
  double time = 0.0;  ///< [s] since the start of the drive
  MapErrors errors;
  std::size_t violations = 0;  ///< of the output contract
  std::string violation;       ///< the first one
  double cost = 0.0;           ///< [s] that its inputs and its tick took
  bool painted = false;        ///< paint took part in its current lane
  double claimed = -1.0;       ///< [m] the standard deviation of its lane's place; -1: none
  std::string remarks;         ///< its status' text, and what the pipeline says beside it
};

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
  std::size_t consistent = 0, consistent_of = 0;  ///< maps; of those that claim a standard deviation
  std::size_t painted = 0;                        ///< maps
  double worst_second = std::numeric_limits<double>::quiet_NaN();  ///< [m] RMS 10 m ahead in it
  std::size_t violations = 0;
  std::string violation;  ///< the first one

  /// A share of maps; NaN: none that could tell.
  double usable_share() const { return share(usable, usable_of); }
  double consistent_share() const { return share(consistent, consistent_of); }
  double painted_share() const { return share(painted, cost.count()); }

  void add(const MeasuredMap& map);
  /// All maps of a drive, in their order.
  void add(const std::vector<MeasuredMap>& drive);
  void add(const AccuracyRow& other);

 private:
  static double share(std::size_t part, std::size_t of) {
    return of == 0 ? std::numeric_limits<double>::quiet_NaN()
                   : static_cast<double>(part) / static_cast<double>(of);
  }
};

}  // namespace relative_map::core
