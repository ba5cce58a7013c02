#include "relative_map/localization/geodesy/tangent_plane.hpp"

#include <vector>

namespace relative_map::core {

namespace {

using RowMajor = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

/// Turns vectors of the plane to the earth-centred frame.
Eigen::Matrix3d earth_from_plane(const GeoPoint& origin) {
  const GeographicLib::Geocentric& earth = GeographicLib::Geocentric::WGS84();
  double x, y, z;
  std::vector<double> m(9);
  earth.Forward(origin.latitude, origin.longitude, origin.altitude, x, y, z, m);
  return Eigen::Map<const RowMajor>(m.data());
}

}  // namespace

TangentPlane::TangentPlane(const GeoPoint& origin)
    : origin_(origin), plane_(origin.latitude, origin.longitude, origin.altitude) {}

Eigen::Vector3d TangentPlane::to_plane(const GeoPoint& point) const {
  Eigen::Vector3d position;
  plane_.Forward(point.latitude, point.longitude, point.altitude, position.x(), position.y(), position.z());
  return position;
}

GeoPoint TangentPlane::to_earth(const Eigen::Vector3d& position) const {
  GeoPoint point;
  plane_.Reverse(position.x(), position.y(), position.z(), point.latitude, point.longitude, point.altitude);
  return point;
}

Eigen::Matrix3d TangentPlane::rotation_from(const TangentPlane& other) const {
  return earth_from_plane(origin_).transpose() * earth_from_plane(other.origin_);
}

Eigen::Matrix3d TangentPlane::local_from_plane(const Eigen::Vector3d& position) const {
  double latitude, longitude, altitude;
  std::vector<double> m(9);
  plane_.Reverse(position.x(), position.y(), position.z(), latitude, longitude, altitude, m);
  // It turns local vectors into the plane.
  return Eigen::Map<const RowMajor>(m.data()).transpose();
}

}  // namespace relative_map::core
