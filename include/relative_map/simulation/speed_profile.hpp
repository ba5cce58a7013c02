#pragma once

#include <cstddef>
#include <vector>

#include "relative_map/simulation/drive_path.hpp"

namespace relative_map::core {

struct SpeedParam {
  double max_speed = 15.0;                ///< [m/s]
  double max_lateral_acceleration = 2.0;  ///< [m/s^2] in curves
  double max_acceleration = 1.5;          ///< [m/s^2]
  double max_deceleration = 2.0;          ///< [m/s^2] ahead of curves, and of the end of an open line
};

/// How fast a path may be driven, place by place: slow enough for the curve there, and to brake for what is
/// ahead.
class SpeedProfile {
 public:
  /// An open path may be driven on up to `stop_s` [m], or if that is 0 up to its end.
  SpeedProfile(const DrivePath& path, const SpeedParam& param, double stop_s = 0.0);

  /// [m/s] at s [m], which lies at or after the path's vertex `vertex`.
  double limit(double s, std::size_t vertex) const;

 private:
  struct Limit {
    double s;              ///< [m]
    double squared_speed;  ///< [m^2/s^2] linear in s where the vehicle brakes
  };
  std::vector<Limit> limits_;  ///< by vertex of the path
};

}  // namespace relative_map::core
