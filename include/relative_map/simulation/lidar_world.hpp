#pragma once

#include <Eigen/Geometry>
#include <random>
#include <vector>

#include "relative_map/model/point_cloud.hpp"

namespace relative_map::core {

/// What a lidar sees of a street along x: ground with kerbs, paint on it, walls and poles. Lengths in m,
/// intensities from 0 to 100. The road's surface is z = 0.
struct LidarWorld {
  struct Wall {
    Eigen::Vector2d from, to;
    double height, intensity;
  };
  struct Pole {
    Eigen::Vector2d at;
    double radius, height, intensity;
  };
  struct Paint {
    Eigen::Vector2d from, to;
    double width, intensity;
  };
  std::vector<Wall> walls;
  std::vector<Pole> poles;
  std::vector<Paint> paint;
  double kerb = 7.0;  ///< [m] of the kerbs from the middle of the road
  double kerb_height = 0.12;
  double asphalt = 12.0, pavement = 25.0;  ///< intensities
};

/// A street of that length [m] from x = 0 on: dashes in its middle, solid lines at its edges, a crossing,
/// arrows, houses with gaps between them, and lamps.
LidarWorld street(double length, unsigned seed);

/// A lidar that turns: `channels` beams between two elevations.
struct LidarSensor {
  int channels = 32;
  double lowest = -0.436, highest = 0.175;  ///< [rad]
  double azimuth_step = 0.0087;             ///< [rad] (0.5 deg)
  double range = 60.0;                      ///< [m]
  double range_stddev = 0.02;               ///< [m]
  double intensity_stddev = 3.0;
};

/// One sweep, in the sensor's frame; all of it is seen at once, from `world_from_sensor`.
PointCloud look(const LidarWorld& world, const LidarSensor& sensor,
                const Eigen::Isometry3d& world_from_sensor, std::mt19937& random);

}  // namespace relative_map::core
