#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

namespace relative_map::core {

/// Points of a lidar, in the frame of whoever hands them on. Double, since the clouds of maps lie at large
/// coordinates. `intensity` and `time` are empty or have a value for each point.
struct PointCloud {
  std::vector<Eigen::Vector3d> points;  ///< [m]
  std::vector<double> intensity;        ///< [-] in the sensor's own scale
  std::vector<double> time;  ///< [s] after the cloud's stamp (or its first point's) that it was seen

  std::size_t size() const { return points.size(); }
  bool empty() const { return points.empty(); }
  bool has_intensity() const { return !points.empty() && intensity.size() == points.size(); }
  bool has_time() const { return !points.empty() && time.size() == points.size(); }
  /// Takes point `i` of `other`, with what is known of it.
  void push_back(const PointCloud& other, std::size_t i) {
    points.push_back(other.points[i]);
    if (other.has_intensity()) intensity.push_back(other.intensity[i]);
    if (other.has_time()) time.push_back(other.time[i]);
  }
};

}  // namespace relative_map::core
