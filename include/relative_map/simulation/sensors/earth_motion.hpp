#pragma once

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/simulation/sensors/sensor_param.hpp"

namespace relative_map::core {

/// The ground's height over a map: a sum of waves in random directions.
class Terrain {
 public:
  Terrain(const TerrainParam& param, std::uint64_t seed);

  /// [m]
  double height(const Point2& place) const;
  /// [-] of the height along map x and y.
  Point2 gradient(const Point2& place) const;

 private:
  struct Wave {
    Point2 number;  ///< [rad/m]
    double phase, amplitude;
  };
  std::vector<Wave> waves_;
};

/// Where a body (FLU, on the ground) is: earth-centred, earth-fixed.
struct EarthPose {
  double time = 0.0;                                   ///< [s]
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m]
  Eigen::Matrix3d earth_from_body = Eigen::Matrix3d::Identity();
  Eigen::Matrix3d earth_from_map = Eigen::Matrix3d::Identity();  ///< of the map's axes there
  double height = 0.0;                                           ///< [m] map z
};

/// Puts poses in a map onto the earth, with the ground's slopes. By GeographicLib, and by nothing of the
/// localizer's, which is to be judged by it.
class MapOnEarth {
 public:
  /// `map` must have a projection.
  MapOnEarth(const GeoReference& map, const Terrain& terrain);

  EarthPose place(double time, const Pose2& map_from_body) const;

 private:
  GeoReference map_;
  Terrain terrain_;
  GeographicLib::LocalCartesian plane_;
};

/// How a point of the body moves, by differences between three poses at equal distances in time; what is
/// integrated from them comes out where the body went.
class BodyMotion {
 public:
  /// Times rise. Empty until there are three at equal distances (within a fifth of a step).
  static std::optional<BodyMotion> from(const std::array<EarthPose, 3>& poses);

  const EarthPose& pose() const { return poses_[1]; }
  /// [m], [m/s], [m/s^2] earth-fixed, of a point [m] of the body.
  Eigen::Vector3d position(const Eigen::Vector3d& point) const { return at(1, point); }
  Eigen::Vector3d velocity(const Eigen::Vector3d& point) const;
  Eigen::Vector3d acceleration(const Eigen::Vector3d& point) const;
  /// [rad/s] over the earth, in the body.
  Eigen::Vector3d rate() const;
  /// What an inertial sensor in the body's axes feels at a point: [rad/s] against the stars, [m/s^2] with
  /// the reaction to gravity (GeographicLib's normal gravity).
  Eigen::Vector3d inertial_rate() const;
  Eigen::Vector3d specific_force(const Eigen::Vector3d& point) const;
  double step() const { return step_; }  ///< [s]

 private:
  Eigen::Vector3d at(std::size_t i, const Eigen::Vector3d& point) const {
    return poses_[i].position + poses_[i].earth_from_body * point;
  }
  std::array<EarthPose, 3> poses_;
  double step_ = 0.0;
};

/// Latitude, longitude, altitude of an earth-fixed place [m].
GeoPoint to_geodetic(const Eigen::Vector3d& position);
/// Turns earth-fixed vectors to east, north, up there.
Eigen::Matrix3d enu_from_earth(const GeoPoint& place);

}  // namespace relative_map::core
