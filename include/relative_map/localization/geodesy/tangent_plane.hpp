#pragma once

#include <Eigen/Core>
#include <GeographicLib/LocalCartesian.hpp>

#include "relative_map/model/geo_reference.hpp"

namespace relative_map::core {

/// East, north, up at an origin, tangent to the ellipsoid there: the frame that filters work in. At a
/// distance d from the origin the ground lies d^2 / 2R below the plane and is tilted by d / R (10 km: 7.8 m
/// and 1.6 mrad), so who moves on takes a new origin and carries over what he knows (`rotation_from`).
class TangentPlane {
 public:
  TangentPlane() = default;
  explicit TangentPlane(const GeoPoint& origin);

  const GeoPoint& origin() const { return origin_; }
  /// [m] east, north, up. The point must have an altitude.
  Eigen::Vector3d to_plane(const GeoPoint& point) const;
  GeoPoint to_earth(const Eigen::Vector3d& position) const;
  /// Turns vectors of `other` to this plane.
  Eigen::Matrix3d rotation_from(const TangentPlane& other) const;
  /// Turns vectors of this plane to east, north, up at a position in it.
  Eigen::Matrix3d local_from_plane(const Eigen::Vector3d& position) const;

 private:
  GeoPoint origin_;
  GeographicLib::LocalCartesian plane_;
};

}  // namespace relative_map::core
