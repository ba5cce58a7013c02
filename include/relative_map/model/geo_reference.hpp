#pragma once

namespace relative_map::core {

enum class Projection {
  kNone,   ///< not known
  kUtm,    ///< easting and northing of a UTM zone
  kLocal,  ///< ENU, tangent to the ellipsoid at an origin
};

/// Where a map frame lies on the earth (WGS 84), as far as it is known.
struct GeoReference {
  Projection projection = Projection::kNone;
  int zone = 0;            ///< UTM: 1 to 60
  bool north = true;       ///< UTM: the hemisphere
  double latitude = 0.0;   ///< [deg] local: of the origin
  double longitude = 0.0;  ///< [deg]
  double altitude = 0.0;   ///< [m] above the ellipsoid
};

/// A place on the WGS 84 ellipsoid.
struct GeoPoint {
  double longitude = 0.0;  ///< [deg] east positive
  double latitude = 0.0;   ///< [deg] north positive
  double altitude = 0.0;   ///< [m] above the ellipsoid; NaN: not given
};

}  // namespace relative_map::core
