#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/localization/pyramid/pyramid_map.hpp"

namespace relative_map::core {

/// What a match goes by.
enum class PyramidWeighing { kFusion, kIntensity, kAltitude };

struct PyramidParam {
  PyramidWeighing weighing = PyramidWeighing::kFusion;
  int reach = 8;                   ///< [-] cells of each level to either side that are tried: 17 x 17
  double yaw_range = 0.0262;       ///< [rad] (1.5 deg) to either side of the guess
  double yaw_step = 0.0026;        ///< [rad] (0.15 deg) of the finest search
  double most_cells = 12000.0;     ///< [-] of the scan that take part
  double intensity_share = 0.2;    ///< [-] of the map's spread of intensity: no cell is known better
  double altitude_stddev = 0.1;    ///< [m] of a cell's mean altitude
  double largest_distance = 3.0;   ///< [-] standard deviations of a cell: farther off counts as so far
  double cells_alike = 30.0;       ///< [-] neighbouring cells err together: so many count as one
  double sharpen = 2.0;            ///< [-] alpha: the pose is the centre of mass of P^alpha
  double min_coverage = 0.8;       ///< [-] share of the scan's cells that the map must know
  double min_upright_share = 0.5;  ///< [-] of the scan's cells off the ground: so many must be so in the map
  double max_second_peak = 0.5;    ///< [-] of the first: higher, and the place is ambiguous
  double max_mean_distance =
      4.0;                   ///< [-] mean squared distance of the cells at the peak; more is another place
  double max_spread = 0.08;  ///< [m^2] sigma_x times sigma_y (as Apollo's)
  double min_stddev = 0.03;  ///< [m] a result is never said to be better
};

/// Likelihoods of positions in the plan: a square of cells.
struct ShiftHistogram {
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< [m] in the map
  int reach = 0;                                     ///< cells to either side
  double cell_size = 0.0;                            ///< [m]
  std::vector<double> p;                             ///< row by row (y), sum 1
  double at(int x, int y) const { return p[(y + reach) * (2 * reach + 1) + x + reach]; }
  double& at(int x, int y) { return p[(y + reach) * (2 * reach + 1) + x + reach]; }
  /// At a place in the map [m], between the cells' middles; the least likelihood there is outside.
  double at(const Eigen::Vector2d& place) const;
};

struct PyramidMatch {
  Eigen::Isometry3d map_from_body = Eigen::Isometry3d::Identity();
  Eigen::Matrix<double, 6, 6> covariance = Eigen::Matrix<double, 6, 6>::Identity();
  ShiftHistogram histogram;       ///< of this scan, and the prior
  double score = 0.0;             ///< (0, 1] exp(-mean squared distance / 2) of the best shift
  double coverage = 0.0;          ///< [0, 1] share of the scan's cells that the map knows
  double upright_share = 1.0;     ///< [0, 1] of the scan's cells off the ground, those that are so in the map
  double intensity_weight = 0.0;  ///< [0, 1] gamma: the intensity's share in the fusion
  double second_peak = 0.0;       ///< [0, 1] height of the second peak over the first's
  int candidates = 0;             ///< shifts and directions that were looked at
  bool believed = false;
  std::vector<std::string> reasons, remarks;
};

/// Where the scan (body frame, z up) lies on the map. The guess's roll and pitch are taken as good; x, y and
/// yaw are searched, from the coarsest level to the finest; z follows from the ground. `prior` is what
/// earlier scans say of the position, from HistogramFilter; it may be null.
PyramidMatch match_pyramid(const PyramidMap& map, const PointCloud& scan, const Eigen::Isometry3d& guess,
                           const PyramidParam& param, const ShiftHistogram* prior = nullptr);

/// Carries likelihoods from scan to scan: what was likely stays so, blurred by the odometry's error.
class HistogramFilter {
 public:
  /// The vehicle has moved by `moved` [m] in the map since the last scan, with an error of `stddev` [m].
  void predict(const Eigen::Vector2d& moved, double stddev);
  /// `seen` has this filter's belief in it, as match_pyramid() makes it.
  void update(const ShiftHistogram& seen) { belief_ = seen; }
  void reset() { belief_.reset(); }
  const ShiftHistogram* belief() const { return belief_ ? &*belief_ : nullptr; }

 private:
  std::optional<ShiftHistogram> belief_;
};

}  // namespace relative_map::core
