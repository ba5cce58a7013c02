#pragma once

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

namespace relative_map::core {

/// Which voxel of a grid: three whole numbers of 21 bits each in one. At voxels of 0.1 m that is 100 km to
/// either side of the grid's origin.
using VoxelKey = std::uint64_t;

constexpr int kVoxelBits = 21;
constexpr std::int64_t kVoxelBias = std::int64_t{1} << (kVoxelBits - 1);
constexpr VoxelKey kVoxelMask = (VoxelKey{1} << kVoxelBits) - 1;
/// No voxel has it.
constexpr VoxelKey kNoVoxel = ~VoxelKey{0};

inline VoxelKey voxel_key(std::int64_t x, std::int64_t y, std::int64_t z) {
  const auto part = [](std::int64_t i) { return static_cast<VoxelKey>(i + kVoxelBias) & kVoxelMask; };
  return part(x) | (part(y) << kVoxelBits) | (part(z) << (2 * kVoxelBits));
}
inline Eigen::Matrix<std::int64_t, 3, 1> voxel_of(VoxelKey key) {
  const auto part = [key](int shift) {
    return static_cast<std::int64_t>((key >> shift) & kVoxelMask) - kVoxelBias;
  };
  return {part(0), part(kVoxelBits), part(2 * kVoxelBits)};
}
/// Floor without a call: this is the innermost loop.
inline std::int64_t floor_of(double value) {
  const auto whole = static_cast<std::int64_t>(value);
  return whole - (value < static_cast<double>(whole) ? 1 : 0);
}
/// `point` relative to the grid's origin, `inverse_size` [1/m] of a voxel's edge.
inline VoxelKey voxel_key(const Eigen::Vector3d& point, double inverse_size) {
  return voxel_key(floor_of(point.x() * inverse_size), floor_of(point.y() * inverse_size),
                   floor_of(point.z() * inverse_size));
}

/// From voxels to indices, in one piece of memory with open addressing: several times faster than
/// std::unordered_map, and a registration does little else than look voxels up.
class VoxelIndex {
 public:
  explicit VoxelIndex(std::size_t expected = 0) { resize(expected); }

  /// The index of a voxel, or -1.
  std::int32_t find(VoxelKey key) const {
    for (std::size_t slot = slot_of(key);; slot = (slot + 1) & mask_) {
      if (slots_[slot].key == key) return slots_[slot].index;
      if (slots_[slot].key == kNoVoxel) return -1;
    }
  }
  /// The index of a voxel; a new one gets `next`.
  std::int32_t insert(VoxelKey key, std::int32_t next) {
    if (2 * (count_ + 1) > slots_.size()) grow();
    for (std::size_t slot = slot_of(key);; slot = (slot + 1) & mask_) {
      if (slots_[slot].key == key) return slots_[slot].index;
      if (slots_[slot].key != kNoVoxel) continue;
      slots_[slot] = {key, next};
      ++count_;
      return next;
    }
  }
  std::size_t size() const { return count_; }

 private:
  struct Slot {
    VoxelKey key = kNoVoxel;
    std::int32_t index = -1;
  };

  std::size_t slot_of(VoxelKey key) const {
    // Fibonacci hashing (Knuth, vol. 3): the upper bits of the product are well mixed.
    return static_cast<std::size_t>((key * 0x9E3779B97F4A7C15ull) >> 32) & mask_;
  }
  void resize(std::size_t expected) {
    std::size_t size = 64;
    while (size < 2 * expected + 2) size *= 2;
    slots_.assign(size, {});
    mask_ = size - 1;
  }
  void grow() {
    std::vector<Slot> old;
    old.swap(slots_);
    resize(old.size());
    count_ = 0;
    for (const Slot& slot : old) {
      if (slot.key != kNoVoxel) insert(slot.key, slot.index);
    }
  }

  std::vector<Slot> slots_;
  std::size_t mask_ = 0;
  std::size_t count_ = 0;
};

}  // namespace relative_map::core
