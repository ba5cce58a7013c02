#include "relative_map/io/geodetic_projection.hpp"

#include <GeographicLib/LocalCartesian.hpp>
#include <GeographicLib/UTMUPS.hpp>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMaxFromMeridian = 6.0;      // [deg] twice half a zone
constexpr double kMaxBeyondEquator = 2.0;     // [deg] a line may lead over the equator
constexpr double kMaxFromOrigin = 200'000.0;  // [m]
constexpr const char* kSwapped = "; are longitude and latitude swapped?";

[[noreturn]] void fail(std::size_t index, const std::string& what) {
  throw std::runtime_error("point " + std::to_string(index) + " " + what);
}

std::string text_of(double number) {
  std::ostringstream text;
  text.precision(10);
  text << number;
  return text.str();
}

void expect_on_earth(const GeoPoint& point, std::size_t index) {
  if (!std::isfinite(point.latitude) || !std::isfinite(point.longitude)) {
    fail(index, "has a longitude or latitude that is not finite");
  }
  if (std::abs(point.latitude) > 90.0) {
    fail(index, "has latitude " + text_of(point.latitude) + ", beyond 90 degrees" + kSwapped);
  }
  if (std::abs(point.longitude) > 180.0) {
    fail(index, "has longitude " + text_of(point.longitude) + ", beyond 180 degrees");
  }
}

GeoReference utm_zone_at(const GeoPoint& point, std::size_t index) {
  expect_on_earth(point, index);
  GeoReference reference;
  reference.projection = Projection::kUtm;
  reference.zone = GeographicLib::UTMUPS::StandardZone(point.latitude, point.longitude);
  reference.north = point.latitude >= 0.0;
  if (reference.zone == GeographicLib::UTMUPS::UPS) {
    fail(index, "has latitude " + text_of(point.latitude) + ", where UTM has no zones" + kSwapped);
  }
  return reference;
}

void expect_finite(const LinePoint& point, std::size_t index) {
  if (!std::isfinite(point.x) || !std::isfinite(point.y)) fail(index, "has an x or y that is not finite");
}

LinePoint line_point(double x, double y, double z) {
  return {x, y, z, kNaN, kNaN, kNaN, kNaN};
}

LinePoint to_utm(const GeoPoint& point, std::size_t index, const GeoReference& reference) {
  const double meridian = 6.0 * reference.zone - 183.0;
  if (std::abs(std::remainder(point.longitude - meridian, 360.0)) > kMaxFromMeridian ||
      point.latitude > 84.0 || point.latitude < -80.0) {
    fail(index, "(longitude " + text_of(point.longitude) + ", latitude " + text_of(point.latitude) +
                    ") lies far outside of " + describe(reference) +
                    ": it is the wrong zone, or longitude and latitude are swapped");
  }
  if ((reference.north ? -point.latitude : point.latitude) > kMaxBeyondEquator) {
    fail(index, "has latitude " + text_of(point.latitude) + ", far on the other side of the equator from " +
                    describe(reference) + ": N and S are its hemispheres, and not bands of latitude");
  }
  int zone = 0;
  bool north = true;
  double x = 0.0, y = 0.0;
  GeographicLib::UTMUPS::Forward(point.latitude, point.longitude, zone, north, x, y, reference.zone);
  if (north && !reference.north) y += GeographicLib::UTMUPS::UTMShift();
  if (!north && reference.north) y -= GeographicLib::UTMUPS::UTMShift();
  return line_point(x, y, point.altitude);
}

GeoPoint from_utm(const LinePoint& point, const GeoReference& reference) {
  GeoPoint result;
  // The northing may go on beyond the equator.
  double y = point.y;
  bool north = reference.north;
  if (north && y < 0.0) {
    north = false;
    y += GeographicLib::UTMUPS::UTMShift();
  } else if (!north && y > GeographicLib::UTMUPS::UTMShift()) {
    north = true;
    y -= GeographicLib::UTMUPS::UTMShift();
  }
  GeographicLib::UTMUPS::Reverse(reference.zone, north, point.x, y, result.latitude, result.longitude);
  result.altitude = point.z;
  return result;
}

LinePoint to_local(const GeoPoint& point, std::size_t index, const GeoReference& reference,
                   const GeographicLib::LocalCartesian& plane) {
  const bool has_altitude = std::isfinite(point.altitude);
  double x = 0.0, y = 0.0, z = 0.0;
  plane.Forward(point.latitude, point.longitude, has_altitude ? point.altitude : reference.altitude, x, y, z);
  if (std::hypot(x, y) > kMaxFromOrigin || z < -kMaxFromOrigin) {
    fail(index, "(longitude " + text_of(point.longitude) + ", latitude " + text_of(point.latitude) +
                    ") lies more than 200 km from the origin: it is the wrong origin, or longitude and "
                    "latitude are swapped");
  }
  return line_point(x, y, has_altitude ? z : kNaN);
}

GeoPoint from_local(const LinePoint& point, std::size_t index, const GeoReference& reference,
                    const GeographicLib::LocalCartesian& plane) {
  if (std::hypot(point.x, point.y) > kMaxFromOrigin) {
    fail(index, "lies more than 200 km from the origin");
  }
  GeoPoint result;
  if (std::isfinite(point.z)) {
    plane.Reverse(point.x, point.y, point.z, result.latitude, result.longitude, result.altitude);
    return result;
  }
  // As high as the origin: far from there, that is below the plane.
  double z = 0.0;
  for (int round = 0; round < 8; ++round) {
    plane.Reverse(point.x, point.y, z, result.latitude, result.longitude, result.altitude);
    z -= result.altitude - reference.altitude;
  }
  result.altitude = kNaN;
  return result;
}

GeographicLib::LocalCartesian plane_of(const GeoReference& reference) {
  return {reference.latitude, reference.longitude, reference.altitude};
}

[[noreturn]] void fail_without_projection() {
  throw std::runtime_error("the line's place on the earth is not known");
}

}  // namespace

GeoReference utm_zone_of(const std::vector<GeoPoint>& points) {
  if (points.empty()) throw std::runtime_error("has no points");
  const GeoReference first = utm_zone_at(points[0], 0);
  for (std::size_t i = 1; i < points.size(); ++i) {
    const GeoReference other = utm_zone_at(points[i], i);
    if (other.zone == first.zone) continue;  // the equator is no border
    fail(i, "lies in " + describe(other) + ", those before it in " + describe(first) +
                ": name one zone for all, or take a local frame");
  }
  return first;
}

GeoReference parse_utm_zone(const std::string& text) {
  GeoReference reference;
  reference.projection = Projection::kUtm;
  char hemisphere = 0, rest = 0;
  std::istringstream stream(text);
  stream >> reference.zone >> hemisphere;
  const bool good = stream && !(stream >> rest) && reference.zone >= 1 && reference.zone <= 60 &&
                    (hemisphere == 'N' || hemisphere == 'S');
  if (!good) throw std::runtime_error("'" + text + "' is no UTM zone: it must be like 50N or 33S");
  reference.north = hemisphere == 'N';
  return reference;
}

std::vector<LinePoint> project(const std::vector<GeoPoint>& points, const GeoReference& reference) {
  if (reference.projection == Projection::kNone) fail_without_projection();
  const bool utm = reference.projection == Projection::kUtm;
  const GeographicLib::LocalCartesian plane = plane_of(reference);
  std::vector<LinePoint> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    expect_on_earth(points[i], i);
    result.push_back(utm ? to_utm(points[i], i, reference) : to_local(points[i], i, reference, plane));
  }
  return result;
}

std::vector<GeoPoint> unproject(const std::vector<LinePoint>& points, const GeoReference& reference) {
  if (reference.projection == Projection::kNone) fail_without_projection();
  const bool utm = reference.projection == Projection::kUtm;
  const GeographicLib::LocalCartesian plane = plane_of(reference);
  std::vector<GeoPoint> result;
  result.reserve(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    expect_finite(points[i], i);
    try {
      result.push_back(utm ? from_utm(points[i], reference) : from_local(points[i], i, reference, plane));
    } catch (const GeographicLib::GeographicErr&) {
      fail(i, "(" + text_of(points[i].x) + ", " + text_of(points[i].y) + ") lies outside of " +
                  describe(reference));
    }
  }
  return result;
}

}  // namespace relative_map::core
