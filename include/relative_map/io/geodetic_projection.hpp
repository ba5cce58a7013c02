#pragma once

#include <memory>
#include <string>
#include <vector>

#include "relative_map/io/line_header.hpp"
#include "relative_map/model/geo_reference.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

/// The UTM zone of all these points. Throws std::runtime_error, one sentence, if there is none that holds
/// them all, or a point lies on no zone (near the poles) or is not on the earth.
GeoReference utm_zone_of(const std::vector<GeoPoint>& points);

/// Reads "50N" or "33S"; throws std::runtime_error.
GeoReference parse_utm_zone(const std::string& text);

/// Map coordinates of points on the earth, and back, to nanometres. What has no altitude is taken to be as
/// high as the origin, and has no z. The other fields of a LinePoint are not given.
/// Both throw std::runtime_error, one sentence that names the point, for coordinates that are not finite, not
/// on the earth, or so far from the zone or the origin that these can't be meant: more than 6 degrees of
/// longitude from the middle of the zone, or 200 km from the origin. Without a projection both throw.
std::vector<LinePoint> project(const std::vector<GeoPoint>& points, const GeoReference& reference);
std::vector<GeoPoint> unproject(const std::vector<LinePoint>& points, const GeoReference& reference);

}  // namespace relative_map::core
