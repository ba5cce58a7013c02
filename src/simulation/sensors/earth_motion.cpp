#include "relative_map/simulation/sensors/earth_motion.hpp"

#include <Eigen/Geometry>
#include <GeographicLib/Geocentric.hpp>
#include <GeographicLib/NormalGravity.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <random>

#include "relative_map/simulation/random_process.hpp"

namespace relative_map::core {

namespace {

using GeographicLib::Geocentric;
using GeographicLib::UTMUPS;

constexpr int kWaves = 8;
constexpr std::uint32_t kTerrainStream = 40;
constexpr double kDegree = M_PI / 180.0;

Eigen::Matrix3d matrix_of(const std::vector<double>& rows) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(rows.data());
}

/// The body's axes in the map's: x towards the heading along the ground, z across it.
Eigen::Matrix3d on_ground(const Pose2& map_from_body, const Point2& gradient) {
  const Point2& ahead = map_from_body.forward();
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(ahead.x(), ahead.y(), gradient.dot(ahead)).normalized();
  axes.col(2) = Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return axes;
}

Eigen::Vector3d earth_rate() {
  return {0.0, 0.0, GeographicLib::NormalGravity::WGS84().AngularVelocity()};
}

}  // namespace

Terrain::Terrain(const TerrainParam& param, std::uint64_t seed) {
  std::mt19937_64 engine = random_engine(seed, kTerrainStream);
  std::uniform_real_distribution<double> angle(-M_PI, M_PI), share(0.4, 1.0);
  for (int i = 0; i < kWaves; ++i) {
    const double direction = angle(engine);
    const double number = 2.0 * M_PI / (share(engine) * param.wavelength);
    // A wave's slope along itself has a variance of (amplitude * number)^2 / 2, in any direction half of it.
    waves_.push_back({number * Point2(std::cos(direction), std::sin(direction)), angle(engine),
                      2.0 * param.slope / number / std::sqrt(kWaves)});
  }
}

double Terrain::height(const Point2& place) const {
  double height = 0.0;
  for (const Wave& wave : waves_) height += wave.amplitude * std::sin(wave.number.dot(place) + wave.phase);
  return height;
}

Point2 Terrain::gradient(const Point2& place) const {
  Point2 gradient = Point2::Zero();
  for (const Wave& wave : waves_) {
    gradient += wave.amplitude * std::cos(wave.number.dot(place) + wave.phase) * wave.number;
  }
  return gradient;
}

MapOnEarth::MapOnEarth(const GeoReference& map, const Terrain& terrain)
    : map_(map), terrain_(terrain), plane_(map.latitude, map.longitude, map.altitude) {}

EarthPose MapOnEarth::place(double time, const Pose2& map_from_body) const {
  const Point2& here = map_from_body.position();
  EarthPose pose;
  pose.time = time;
  pose.height = terrain_.height(here);
  Point2 gradient = terrain_.gradient(here);
  double latitude = map_.latitude, longitude = map_.longitude, altitude = map_.altitude;
  std::vector<double> turn(9);
  if (map_.projection == Projection::kUtm) {
    double convergence = 0.0, scale = 1.0;
    UTMUPS::Reverse(map_.zone, map_.north, here.x(), here.y(), latitude, longitude, convergence, scale);
    pose.height += map_.altitude;
    gradient *= scale;  // a metre of the map is shorter on the ground where the scale is above 1
    Geocentric::WGS84().Forward(latitude, longitude, pose.height, pose.position.x(), pose.position.y(),
                                pose.position.z(), turn);
    // The convergence is the bearing of grid north, clockwise.
    pose.earth_from_map =
        matrix_of(turn) * Eigen::AngleAxisd(-convergence * kDegree, Eigen::Vector3d::UnitZ());
  } else {
    plane_.Reverse(here.x(), here.y(), pose.height, latitude, longitude, altitude);
    Geocentric::WGS84().Forward(latitude, longitude, altitude, pose.position.x(), pose.position.y(),
                                pose.position.z());
    double x, y, z;
    Geocentric::WGS84().Forward(map_.latitude, map_.longitude, map_.altitude, x, y, z, turn);
    pose.earth_from_map = matrix_of(turn);
  }
  pose.earth_from_body = pose.earth_from_map * on_ground(map_from_body, gradient);
  return pose;
}

std::optional<BodyMotion> BodyMotion::from(const std::array<EarthPose, 3>& poses) {
  const double before = poses[1].time - poses[0].time, after = poses[2].time - poses[1].time;
  if (!(before > 0.0) || !(after > 0.0) || std::abs(after - before) > 0.2 * before) return std::nullopt;
  BodyMotion motion;
  motion.poses_ = poses;
  motion.step_ = 0.5 * (before + after);
  return motion;
}

Eigen::Vector3d BodyMotion::velocity(const Eigen::Vector3d& point) const {
  return (at(2, point) - at(0, point)) / (2.0 * step_);
}

Eigen::Vector3d BodyMotion::acceleration(const Eigen::Vector3d& point) const {
  return ((at(2, point) - at(1, point)) - (at(1, point) - at(0, point))) / (step_ * step_);
}

Eigen::Vector3d BodyMotion::rate() const {
  const Eigen::AngleAxisd turn(
      Eigen::Matrix3d(poses_[0].earth_from_body.transpose() * poses_[2].earth_from_body));
  return turn.angle() / (2.0 * step_) * turn.axis();
}

Eigen::Vector3d BodyMotion::inertial_rate() const {
  return rate() + pose().earth_from_body.transpose() * earth_rate();
}

Eigen::Vector3d BodyMotion::specific_force(const Eigen::Vector3d& point) const {
  const Eigen::Vector3d here = position(point);
  Eigen::Vector3d gravity;  // with the earth's centrifugal force
  GeographicLib::NormalGravity::WGS84().U(here.x(), here.y(), here.z(), gravity.x(), gravity.y(),
                                          gravity.z());
  const Eigen::Vector3d coriolis = 2.0 * earth_rate().cross(velocity(point));
  return pose().earth_from_body.transpose() * (acceleration(point) + coriolis - gravity);
}

GeoPoint to_geodetic(const Eigen::Vector3d& position) {
  GeoPoint place;
  Geocentric::WGS84().Reverse(position.x(), position.y(), position.z(), place.latitude, place.longitude,
                              place.altitude);
  return place;
}

Eigen::Matrix3d enu_from_earth(const GeoPoint& place) {
  double x, y, z;
  std::vector<double> turn(9);
  Geocentric::WGS84().Forward(place.latitude, place.longitude, place.altitude, x, y, z, turn);
  return matrix_of(turn).transpose();
}

}  // namespace relative_map::core
