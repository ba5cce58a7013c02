#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

namespace relative_map::core {

/// Finds which way a dead-reckoned path lies: the turn that lays its points on the fixes that were taken at
/// them (least squares in two dimensions; Umeyama 1991). So a heading is found from positions alone, at any
/// speed and along any path that is long enough.
class PathMatch {
 public:
  /// [m] both; `stddev` of the fix.
  void add(const Eigen::Vector2d& dead_reckoned, const Eigen::Vector2d& fix, double stddev);
  void clear() { pairs_.clear(); }

  struct Turn {
    double angle = 0.0;   ///< [rad] from the path's axes to the fixes'
    double stddev = 0.0;  ///< [rad]
  };
  /// None while there are too few points, or they do not lie on each other by any turn.
  std::optional<Turn> turn() const;

 private:
  struct Pair {
    Eigen::Vector2d path, fix;
    double stddev;
  };
  static constexpr std::size_t kMost = 40;  ///< then every other one is left out
  std::vector<Pair> pairs_;
};

}  // namespace relative_map::core
