#pragma once

#include <deque>
#include <optional>
#include <string>
#include <utility>

#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// The inertial samples of the last two seconds, whatever their rate.
class ImuBuffer {
 public:
  /// Samples may come in any order; one of a stamp that is there already, or too old, is dropped.
  void add(Time stamp, const ImuSample& sample);
  bool empty() const { return samples_.empty(); }
  Time newest() const { return samples_.back().first; }

  struct Found {
    std::optional<ImuSample> sample;  ///< linear between the two neighbours
    std::string why_not;              ///< a sentence, where there is none
  };
  /// Of a time between two samples that are at most `max_bracket` [s] apart. Nothing is extrapolated.
  Found at(Time time, double max_bracket) const;

 private:
  std::deque<std::pair<Time, ImuSample>> samples_;
};

}  // namespace relative_map::core
