#include "relative_map/prediction/noise_meter.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

const double kThirdDifference = std::sqrt(1.0 + 9.0 + 9.0 + 1.0);
constexpr double kMedianOfNormal = 0.6745;  // of the absolute value, in standard deviations
constexpr double kStepTolerance = 0.2;      // [-] by which steps may differ
constexpr double kMemory = 2000.0;          // [samples] older ones count less
constexpr double kFirstGuess = 0.2;         // [m] a good lidar's boxes, until there is something to measure

}  // namespace

NoiseMeter::NoiseMeter(const MotionFilterParam& param)
    : least_(std::min(param.min_position_stddev, param.min_pedestrian_stddev)),
      most_(param.max_position_stddev),
      stddev_(std::clamp(kFirstGuess, least_, most_)) {}

void NoiseMeter::add(const Point2 positions[4], const double steps[3]) {
  const auto [shortest, longest] = std::minmax_element(steps, steps + 3);
  if (*longest > (1.0 + kStepTolerance) * *shortest) return;
  const Point2 third = positions[3] - 3.0 * positions[2] + 3.0 * positions[1] - positions[0];
  frame_.push_back(std::abs(third.x()));
  frame_.push_back(std::abs(third.y()));
}

void NoiseMeter::end_frame() {
  if (frame_.empty()) return;
  // The median: a road user that swapped its id must not count.
  const auto middle = frame_.begin() + static_cast<std::ptrdiff_t>(frame_.size() / 2);
  std::nth_element(frame_.begin(), middle, frame_.end());
  const double measured = std::clamp(*middle / (kMedianOfNormal * kThirdDifference), least_, most_);
  const double count = static_cast<double>(frame_.size());
  frame_.clear();
  const double variance = (weight_ * stddev_ * stddev_ + count * measured * measured) / (weight_ + count);
  stddev_ = std::sqrt(variance);
  weight_ = std::min(weight_ + count, kMemory);
}

}  // namespace relative_map::core
