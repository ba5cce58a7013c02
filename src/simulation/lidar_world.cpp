#include "relative_map/simulation/lidar_world.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>

namespace relative_map::core {

namespace {

struct Hit {
  double distance = 0.0;  ///< [m] along the ray
  double intensity = 0.0;
};

void keep_nearer(std::optional<Hit>& nearest, double distance, double intensity) {
  if (distance > 0.1 && (!nearest || distance < nearest->distance)) nearest = Hit{distance, intensity};
}

/// Asphalt is no single grey: patches of half a metre, the same at each pass.
double patch(double x, double y) {
  const auto ix = static_cast<std::int64_t>(std::floor(2.0 * x)),
             iy = static_cast<std::int64_t>(std::floor(2.0 * y));
  const std::uint64_t mixed =
      static_cast<std::uint64_t>(ix * 73856093 ^ iy * 19349663) * 0x9E3779B97F4A7C15ull;
  return static_cast<double>(mixed >> 40) / static_cast<double>(1 << 24) * 6.0 - 3.0;
}

double intensity_of_ground(const LidarWorld& world, const Eigen::Vector2d& at) {
  if (std::abs(at.y()) > world.kerb) return world.pavement + patch(at.x(), at.y());
  for (const LidarWorld::Paint& paint : world.paint) {
    const Eigen::Vector2d along = paint.to - paint.from;
    const double length = along.norm();
    const double s = (at - paint.from).dot(along) / length;
    if (s < 0.0 || s > length) continue;
    const Eigen::Vector2d off = at - paint.from - s / length * along;
    if (off.norm() <= 0.5 * paint.width) return paint.intensity;
  }
  return world.asphalt + patch(at.x(), at.y());
}

void hit_ground(const LidarWorld& world, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
                std::optional<Hit>& nearest) {
  if (ray.z() < 0.0) {
    for (const bool road : {true, false}) {
      const double distance = ((road ? 0.0 : world.kerb_height) - from.z()) / ray.z();
      const Eigen::Vector3d at = from + distance * ray;
      if ((std::abs(at.y()) <= world.kerb) != road) continue;
      keep_nearer(nearest, distance, intensity_of_ground(world, at.head<2>()));
    }
  }
  for (const double y : {-world.kerb, world.kerb}) {
    const double distance = (y - from.y()) / ray.y();
    const double z = from.z() + distance * ray.z();
    if (z >= 0.0 && z <= world.kerb_height) keep_nearer(nearest, distance, 40.0);
  }
}

void hit_walls(const LidarWorld& world, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
               std::optional<Hit>& nearest) {
  for (const LidarWorld::Wall& wall : world.walls) {
    // from + d ray = a + u (b - a), in the plan.
    const Eigen::Vector2d side = wall.to - wall.from, away = wall.from - from.head<2>();
    const double cross = ray.x() * side.y() - ray.y() * side.x();
    if (std::abs(cross) < 1e-12) continue;
    const double distance = (away.x() * side.y() - away.y() * side.x()) / cross;
    const double u = (away.x() * ray.y() - away.y() * ray.x()) / cross;
    const double z = from.z() + distance * ray.z();
    if (u < 0.0 || u > 1.0 || z > wall.height) continue;
    keep_nearer(nearest, distance, wall.intensity);
  }
}

void hit_poles(const LidarWorld& world, const Eigen::Vector3d& from, const Eigen::Vector3d& ray,
               std::optional<Hit>& nearest) {
  const double flat = ray.head<2>().squaredNorm();
  for (const LidarWorld::Pole& pole : world.poles) {
    const Eigen::Vector2d away = from.head<2>() - pole.at;
    const double b = away.dot(ray.head<2>()), c = away.squaredNorm() - pole.radius * pole.radius;
    const double root = b * b - flat * c;
    if (root < 0.0 || c < 0.0) continue;
    const double distance = (-b - std::sqrt(root)) / flat;
    if (from.z() + distance * ray.z() > pole.height) continue;
    keep_nearer(nearest, distance, pole.intensity);
  }
}

}  // namespace

LidarWorld street(double length, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  LidarWorld world;
  const double edge = 3.6;
  world.paint.push_back({{-50.0, edge}, {length + 50.0, edge}, 0.15, 80.0});
  world.paint.push_back({{-50.0, -edge}, {length + 50.0, -edge}, 0.15, 80.0});
  for (double x = -50.0; x < length + 50.0; x += 9.0)
    world.paint.push_back({{x, 0.0}, {x + 3.0, 0.0}, 0.15, 80.0});
  for (double x = 20.0 * unit(random); x < length; x += 25.0 + 20.0 * unit(random)) {
    world.paint.push_back({{x, 1.8}, {x + 2.5, 1.8}, 0.2, 75.0});  // an arrow's shaft
    world.paint.push_back({{x + 2.5, 1.4}, {x + 2.5, 2.2}, 0.5, 75.0});
  }
  for (double y = -edge + 0.5; y < edge; y += 1.0) {
    world.paint.push_back({{0.6 * length, y}, {0.6 * length + 3.0, y}, 0.5, 80.0});  // a crossing
  }
  for (const double side : {-1.0, 1.0}) {
    double x = -60.0;
    while (x < length + 60.0) {
      const double long_ = 8.0 + 15.0 * unit(random), y = side * (11.0 + 4.0 * unit(random));
      const double height = 4.0 + 6.0 * unit(random), grey = 15.0 + 40.0 * unit(random);
      world.walls.push_back({{x, y}, {x + long_, y}, height, grey});
      world.walls.push_back({{x, y}, {x, y + side * 8.0}, height, grey});
      world.walls.push_back({{x + long_, y}, {x + long_, y + side * 8.0}, height, grey});
      x += long_ + 2.0 + 8.0 * unit(random);
    }
    for (x = -60.0 + 10.0 * unit(random); x < length + 60.0; x += 15.0 + 20.0 * unit(random)) {
      world.poles.push_back({{x, side * (world.kerb + 0.6)}, 0.08 + 0.1 * unit(random), 5.0, 50.0});
    }
  }
  return world;
}

PointCloud look(const LidarWorld& world, const LidarSensor& sensor,
                const Eigen::Isometry3d& world_from_sensor, std::mt19937& random) {
  std::normal_distribution<double> normal;
  PointCloud cloud;
  const Eigen::Vector3d from = world_from_sensor.translation();
  const int steps = static_cast<int>(2.0 * 3.14159265358979 / sensor.azimuth_step);
  const double phase = std::uniform_real_distribution<double>(0.0, sensor.azimuth_step)(random);
  for (int step = 0; step < steps; ++step) {
    const double azimuth = phase + step * sensor.azimuth_step;
    for (int channel = 0; channel < sensor.channels; ++channel) {
      const double elevation =
          sensor.lowest + (sensor.highest - sensor.lowest) * channel / std::max(1, sensor.channels - 1);
      const Eigen::Vector3d beam(std::cos(elevation) * std::cos(azimuth),
                                 std::cos(elevation) * std::sin(azimuth), std::sin(elevation));
      const Eigen::Vector3d ray = world_from_sensor.linear() * beam;
      std::optional<Hit> hit;
      hit_ground(world, from, ray, hit);
      hit_walls(world, from, ray, hit);
      hit_poles(world, from, ray, hit);
      if (!hit || hit->distance > sensor.range) continue;
      cloud.points.push_back((hit->distance + sensor.range_stddev * normal(random)) * beam);
      cloud.intensity.push_back(std::max(0.0, hit->intensity + sensor.intensity_stddev * normal(random)));
    }
  }
  return cloud;
}

}  // namespace relative_map::core
