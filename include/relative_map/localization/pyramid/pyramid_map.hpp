#pragma once

#include <Eigen/Core>
#include <vector>

#include "relative_map/localization/clouds/voxel_grid.hpp"
#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core {

/// Number, mean and sum of squared deviations; two of them add up to that of all their values (Welford; Chan
/// et al., 1979).
struct Moments {
  double count = 0.0, mean = 0.0, squares = 0.0;
  void add(double value);
  void add(const Moments& other);
  double variance() const { return count > 1.0 ? squares / (count - 1.0) : 0.0; }
};

/// What is known of a cell of the ground plan.
struct PyramidCell {
  Moments intensity;  ///< [-] the sensor's scale
  Moments altitude;   ///< [m] of all points
  Moments ground;     ///< [m] of those that lie on the ground; count 0: none does
  void add(const PyramidCell& other);
};

/// One level: square cells in the plan, those that have points.
class PyramidLevel {
 public:
  explicit PyramidLevel(double cell_size) : cell_size_(cell_size) {}
  double cell_size() const { return cell_size_; }
  /// Cell (x, y) covers [x, x + 1) by [y, y + 1) times the cell's size from the map's origin.
  PyramidCell& at(std::int64_t x, std::int64_t y);
  const PyramidCell* find(std::int64_t x, std::int64_t y) const;
  const std::vector<PyramidCell>& cells() const { return cells_; }
  /// Of cell `i`.
  Eigen::Matrix<std::int64_t, 2, 1> place(std::size_t i) const { return voxel_of(keys_[i]).head<2>(); }
  /// The same, in cells of twice the size: counts added, means weighed by them.
  PyramidLevel merged() const;

 private:
  double cell_size_;
  VoxelIndex index_;
  std::vector<VoxelKey> keys_;
  std::vector<PyramidCell> cells_;
};

/// Intensity and altitude of the surroundings in levels of cells, each twice as large as those before.
class PyramidMap {
 public:
  static constexpr int kLevels = 3;
  static constexpr double kGroundBand = 0.3;   ///< [m] above the lowest of its block a point is on the ground
  static constexpr double kGroundBlock = 1.0;  ///< [m]

  /// `cell_size` [m] of the finest level; `origin` [m], in the plan.
  PyramidMap(double cell_size, const Eigen::Vector2d& origin);

  /// Points in the map's frame, z up, of one sweep or many.
  void add(const PointCloud& cloud);
  /// To be called after the last add(): makes the coarser levels.
  void finish();

  const Eigen::Vector2d& origin() const { return origin_; }
  /// 0 is the finest.
  const PyramidLevel& level(int i) const { return levels_[i]; }
  bool empty() const { return levels_[0].cells().empty(); }

 private:
  Eigen::Vector2d origin_;
  std::vector<PyramidLevel> levels_;
};

}  // namespace relative_map::core
