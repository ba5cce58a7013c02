#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <random>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core::test {

/// Ground, two walls at right angles, a third one askew, and poles: seen with noise of `sigma` [m]. Points
/// lie in the frame of a sensor in the middle, 1.8 m above the ground.
inline PointCloud yard(unsigned seed, std::size_t count = 40000, double sigma = 0.02) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, sigma);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = unit(random), v = unit(random), which = unit(random);
    Eigen::Vector3d point;
    if (which < 0.45) {
      point = {60.0 * u - 30.0, 50.0 * v - 25.0, -1.8};
    } else if (which < 0.6) {
      point = {60.0 * u - 30.0, 25.0, 6.0 * v - 1.8};
    } else if (which < 0.75) {
      point = {-30.0, 50.0 * u - 25.0, 5.0 * v - 1.8};
    } else if (which < 0.9) {
      point = {10.0 + 15.0 * u, -20.0 + 12.0 * u, 4.0 * v - 1.8};
    } else {
      const double k = std::floor(8.0 * u), turn = 6.28 * 8.0 * u;
      point = {-20.0 + 6.0 * k + 0.2 * std::cos(turn), 8.0 - 3.0 * std::fmod(k, 3.0) + 0.2 * std::sin(turn),
               4.0 * v - 1.8};
    }
    cloud.points.push_back(point + Eigen::Vector3d(noise(random), noise(random), noise(random)));
  }
  return cloud;
}

/// Ground and two walls that go on and on, seen along 120 m: nothing tells how far along one is.
inline PointCloud corridor(unsigned seed, std::size_t count = 30000) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> noise(0.0, 0.02);
  PointCloud cloud;
  for (std::size_t i = 0; i < count; ++i) {
    const double x = 120.0 * unit(random) - 60.0, v = unit(random), which = unit(random);
    const Eigen::Vector3d point = which < 0.4   ? Eigen::Vector3d(x, 8.0 * v - 4.0, -1.8)
                                  : which < 0.7 ? Eigen::Vector3d(x, 4.0, 5.0 * v - 1.8)
                                                : Eigen::Vector3d(x, -4.0, 5.0 * v - 1.8);
    cloud.points.push_back(point + Eigen::Vector3d(noise(random), noise(random), noise(random)));
  }
  return cloud;
}

inline Eigen::Isometry3d pose(double x, double y, double z, double roll, double pitch, double yaw) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  result.translation() = Eigen::Vector3d(x, y, z);
  result.linear() =
      (Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * Eigen::AngleAxisd(pitch, Eigen::Vector3d::UnitY()) *
       Eigen::AngleAxisd(roll, Eigen::Vector3d::UnitX()))
          .toRotationMatrix();
  return result;
}

}  // namespace relative_map::core::test
