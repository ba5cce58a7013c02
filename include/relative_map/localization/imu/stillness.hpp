#pragma once

#include <array>

#include "relative_map/localization/measurements.hpp"

namespace relative_map::core {

/// The last two seconds of an inertial sensor, as means of a tenth of a second: whether it stands still, and
/// what it says then. An engine's vibration is gone from the means, a rolling wheel's is not.
class StillnessWindow {
 public:
  static constexpr int kBlocks = 20;
  static constexpr std::int64_t kBlockNanoseconds = 100'000'000;

  /// Samples come in order; true where one closes a block. After a gap the window begins anew.
  bool add(Time stamp, const ImuSample& sample);
  /// How many blocks there are, at most kBlocks.
  int size() const { return size_; }
  /// Of the newest `blocks`.
  ImuSample mean(int blocks) const;
  /// The widest that any axis of those means spans.
  double rate_span(int blocks) const;
  double force_span(int blocks) const;

 private:
  const ImuSample& block(int back) const { return blocks_[(newest_ + kBlocks - back) % kBlocks]; }

  std::array<ImuSample, kBlocks> blocks_;
  int newest_ = 0, size_ = 0;
  ImuSample sum_;
  int count_ = 0;
  std::int64_t open_ = -1;  ///< number of the block that is being filled
};

}  // namespace relative_map::core
