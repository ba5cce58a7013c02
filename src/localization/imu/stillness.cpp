#include "relative_map/localization/imu/stillness.hpp"

#include <algorithm>

namespace relative_map::core {

bool StillnessWindow::add(Time stamp, const ImuSample& sample) {
  const std::int64_t number = stamp.time_since_epoch().count() / kBlockNanoseconds;
  bool closed = false;
  if (number != open_) {
    if (number == open_ + 1 && count_ > 0) {
      newest_ = (newest_ + 1) % kBlocks;
      blocks_[newest_] = {sum_.angular_velocity / count_, sum_.specific_force / count_};
      size_ = std::min(size_ + 1, kBlocks);
      closed = true;
    } else {
      size_ = 0;
    }
    open_ = number;
    sum_ = ImuSample();
    count_ = 0;
  }
  sum_.angular_velocity += sample.angular_velocity;
  sum_.specific_force += sample.specific_force;
  ++count_;
  return closed;
}

ImuSample StillnessWindow::mean(int blocks) const {
  ImuSample sum;
  const int count = std::min(blocks, size_);
  for (int back = 0; back < count; ++back) {
    sum.angular_velocity += block(back).angular_velocity / count;
    sum.specific_force += block(back).specific_force / count;
  }
  return sum;
}

namespace {

double widest(const Eigen::Array3d& low, const Eigen::Array3d& high) {
  return (high - low).maxCoeff();
}

}  // namespace

double StillnessWindow::rate_span(int blocks) const {
  Eigen::Array3d low = block(0).angular_velocity, high = low;
  for (int back = 1; back < std::min(blocks, size_); ++back) {
    low = low.min(block(back).angular_velocity.array());
    high = high.max(block(back).angular_velocity.array());
  }
  return widest(low, high);
}

double StillnessWindow::force_span(int blocks) const {
  Eigen::Array3d low = block(0).specific_force, high = low;
  for (int back = 1; back < std::min(blocks, size_); ++back) {
    low = low.min(block(back).specific_force.array());
    high = high.max(block(back).specific_force.array());
  }
  return widest(low, high);
}

}  // namespace relative_map::core
