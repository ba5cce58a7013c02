#include "relative_map/localization/geodesy/map_projection.hpp"

#include <Eigen/Geometry>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>

namespace relative_map::core {

namespace {

using GeographicLib::UTMUPS;
constexpr double kMaxFromMeridian = 9.0;      // [deg] beyond, the zone is the wrong one
constexpr double kMaxFromOrigin = 200'000.0;  // [m]
constexpr double kDegree = M_PI / 180.0;

}  // namespace

MapProjection::MapProjection(const GeoReference& reference) : reference_(reference) {
  if (reference.projection == Projection::kLocal) {
    plane_ = TangentPlane({reference.longitude, reference.latitude, reference.altitude});
  }
}

GeoReference MapProjection::zone_at(const GeoPoint& point) {
  GeoReference reference;
  reference.zone = UTMUPS::StandardZone(point.latitude, point.longitude);
  if (reference.zone == UTMUPS::UPS) {
    return {Projection::kLocal, 0, true, point.latitude, point.longitude, point.altitude};
  }
  reference.projection = Projection::kUtm;
  reference.north = point.latitude >= 0.0;
  return reference;
}

std::string MapProjection::refusal(const GeoPoint& point) const {
  if (!std::isfinite(point.latitude) || !std::isfinite(point.longitude)) {
    return "latitude or longitude is not finite";
  }
  if (std::abs(point.latitude) > 90.0 || std::abs(point.longitude) > 360.0) {
    return "latitude or longitude is not on the earth; are they swapped?";
  }
  if (reference_.projection == Projection::kUtm) {
    const double meridian = 6.0 * reference_.zone - 183.0;
    if (std::abs(std::remainder(point.longitude - meridian, 360.0)) > kMaxFromMeridian ||
        std::abs(point.latitude) > 84.0) {
      return "the place lies far outside of the map's UTM zone " + std::to_string(reference_.zone);
    }
    if ((reference_.north ? -point.latitude : point.latitude) > 2.0) {
      return "the place lies in the other hemisphere than the map";
    }
  } else if (plane_.to_plane({point.longitude, point.latitude, reference_.altitude}).norm() >
             kMaxFromOrigin) {
    return "the place lies more than 200 km from the map's origin";
  }
  return "";
}

MapPlace MapProjection::to_map(const GeoPoint& point) const {
  MapPlace place;
  if (reference_.projection == Projection::kLocal) {
    place.position = plane_.to_plane(point);
    place.map_from_local = plane_.local_from_plane(place.position).transpose();
    return place;
  }
  int zone = 0;
  bool north = true;
  double x = 0.0, y = 0.0, convergence = 0.0;
  UTMUPS::Forward(point.latitude, point.longitude, zone, north, x, y, convergence, place.scale,
                  reference_.zone);
  if (north && !reference_.north) y += UTMUPS::UTMShift();
  if (!north && reference_.north) y -= UTMUPS::UTMShift();
  place.position = {x, y, point.altitude};
  // GeographicLib's convergence is the bearing of grid north, clockwise from true north: what bears 0 truly
  // bears minus that on the grid, and so turns counter-clockwise by it.
  place.map_from_local =
      Eigen::AngleAxisd(convergence * kDegree, Eigen::Vector3d::UnitZ()).toRotationMatrix();
  return place;
}

GeoPoint MapProjection::to_earth(const Eigen::Vector3d& position) const {
  if (reference_.projection == Projection::kLocal) return plane_.to_earth(position);
  GeoPoint point;
  double y = position.y();
  bool north = reference_.north;
  // The northing may go on beyond the equator.
  if (north && y < 0.0) {
    north = false;
    y += UTMUPS::UTMShift();
  } else if (!north && y > UTMUPS::UTMShift()) {
    north = true;
    y -= UTMUPS::UTMShift();
  }
  UTMUPS::Reverse(reference_.zone, north, position.x(), y, point.latitude, point.longitude);
  point.altitude = position.z();
  return point;
}

}  // namespace relative_map::core
