#pragma once

#include <Eigen/Core>
#include <string>

#include "relative_map/localization/geodesy/tangent_plane.hpp"
#include "relative_map/model/geo_reference.hpp"

namespace relative_map::core {

/// A place in the map frame, and how that frame lies there.
struct MapPlace {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();  ///< [m] map frame
  /// Turns east, north, up at the place into the map's axes. In UTM by the grid convergence: headings from
  /// grid east are those from true east plus it.
  Eigen::Matrix3d map_from_local = Eigen::Matrix3d::Identity();
  double scale = 1.0;  ///< [-] a metre on the ground is so many in the map (UTM: 0.9996 and up)
};

/// Where a map frame lies on the earth. UTM keeps its zone beyond the zone's border. Its z is the altitude.
class MapProjection {
 public:
  MapProjection() = default;
  /// `reference` must have a projection.
  explicit MapProjection(const GeoReference& reference);

  /// The standard UTM zone of a place. Near the poles, where there are none, a plane tangent at the place.
  static GeoReference zone_at(const GeoPoint& point);

  const GeoReference& reference() const { return reference_; }
  /// Why this point can't be meant by this map, a sentence; empty: it can. A point is refused more than 9
  /// degrees of longitude from the middle of the zone, or 200 km from the origin.
  std::string refusal(const GeoPoint& point) const;
  MapPlace to_map(const GeoPoint& point) const;
  GeoPoint to_earth(const Eigen::Vector3d& position) const;

 private:
  GeoReference reference_;
  TangentPlane plane_;
};

}  // namespace relative_map::core
