// Against values of other sources and closed forms of the ellipsoid.
#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <cmath>

#include "relative_map/localization/geodesy/earth.hpp"
#include "relative_map/localization/geodesy/map_projection.hpp"
#include "relative_map/localization/geodesy/tangent_plane.hpp"

namespace relative_map::core {
namespace {

constexpr double kDegree = M_PI / 180.0;

TEST(Earth, GravityIsThatOfTheEllipsoid) {
  // NIMA TR8350.2, table 3.4: at the equator and at the poles.
  EXPECT_NEAR(normal_gravity(0.0, 0.0), 9.7803253359, 1e-10);
  EXPECT_NEAR(normal_gravity(M_PI_2, 0.0), 9.8321849378, 1e-8);
  // The gradient in free air, 0.3086 mgal a metre.
  EXPECT_NEAR(normal_gravity(45.0 * kDegree, 0.0) - normal_gravity(45.0 * kDegree, 1000.0), 3.086e-3, 3e-6);
}

TEST(Earth, RateIsAlongItsAxis) {
  EXPECT_NEAR(earth_rate_enu(M_PI_2).z(), 7.292115e-5, 1e-12);
  EXPECT_NEAR(earth_rate_enu(0.0).y(), 7.292115e-5, 1e-12);
  EXPECT_NEAR(earth_rate_enu(0.7).norm(), 7.292115e-5, 1e-15);
}

TEST(TangentPlane, CurvesAwayAsTheEarthDoes) {
  const TangentPlane plane({11.0, 48.0, 500.0});
  const GeoPoint there = plane.to_earth({0.0, 10'000.0, 0.0});
  // d^2 / 2M and d / M, M being the meridian's radius of curvature there (6,370,800 m) and the height.
  EXPECT_NEAR(there.altitude - 500.0, 1e8 / 2.0 / 6.3713e6, 0.01);
  const Eigen::Vector3d up_there =
      plane.local_from_plane({0.0, 10'000.0, 0.0}).transpose() * Eigen::Vector3d::UnitZ();
  EXPECT_NEAR(up_there.y(), 1e4 / 6.3713e6, 1e-6);
  EXPECT_NEAR(up_there.x(), 0.0, 1e-9);
}

TEST(TangentPlane, ComesBack) {
  const TangentPlane plane({-105.2, 40.0, 1600.0});
  const Eigen::Vector3d position(1234.5, -4321.0, 17.0);
  EXPECT_LT((plane.to_plane(plane.to_earth(position)) - position).norm(), 1e-7);
}

TEST(TangentPlane, ANewOriginChangesNoVector) {
  const TangentPlane old_plane({8.0, 50.0, 100.0});
  const TangentPlane new_plane(old_plane.to_earth({4000.0, 3000.0, 20.0}));
  const Eigen::Vector3d from(4000.0, 3000.0, 20.0), to(4100.0, 2900.0, 30.0);
  const Eigen::Vector3d moved =
      new_plane.to_plane(old_plane.to_earth(to)) - new_plane.to_plane(old_plane.to_earth(from));
  EXPECT_LT((moved - new_plane.rotation_from(old_plane) * (to - from)).norm(), 1e-7);
  // It is also what the plane says of the local axes at its new origin.
  EXPECT_LT((new_plane.rotation_from(old_plane) - old_plane.local_from_plane(from)).norm(), 1e-12);
}

/// Heading from grid east, of two points a little apart on the earth.
double grid_heading(const MapProjection& map, const GeoPoint& at, double true_heading) {
  const TangentPlane plane(at);
  const double step = 1.0;
  const GeoPoint ahead = plane.to_earth({step * std::cos(true_heading), step * std::sin(true_heading), 0.0});
  const Eigen::Vector3d moved = map.to_map(ahead).position - map.to_map(at).position;
  return std::atan2(moved.y(), moved.x());
}

TEST(MapProjection, HeadingsAreTurnedByTheGridsConvergence) {
  for (const GeoPoint& at :
       {GeoPoint{14.9, 60.0, 0.0}, GeoPoint{9.1, 35.0, 0.0}, GeoPoint{-67.0, -33.0, 800.0}}) {
    const MapProjection map(MapProjection::zone_at(at));
    const MapPlace place = map.to_map(at);
    for (const double heading : {0.0, 1.0, -2.5}) {
      const Eigen::Vector3d ahead =
          place.map_from_local * Eigen::Vector3d(std::cos(heading), std::sin(heading), 0.0);
      EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), grid_heading(map, at, heading), 1e-6);
    }
    // sin(latitude) times the longitude from the middle of the zone, to first order.
    const double meridian = 6.0 * map.reference().zone - 183.0;
    const double expected = (at.longitude - meridian) * kDegree * std::sin(at.latitude * kDegree);
    EXPECT_NEAR(std::atan2(place.map_from_local(1, 0), place.map_from_local(0, 0)), expected, 3e-5);
  }
}

TEST(MapProjection, KeepsItsZoneBeyondTheBorder) {
  const MapProjection map(MapProjection::zone_at({11.99, 48.0, 0.0}));
  EXPECT_EQ(map.reference().zone, 32);
  const Eigen::Vector3d before = map.to_map({11.9999, 48.0, 0.0}).position;
  const Eigen::Vector3d beyond = map.to_map({12.0001, 48.0, 0.0}).position;
  EXPECT_NEAR((beyond - before).norm(), 14.92, 0.02);
}

TEST(MapProjection, CrossesTheEquator) {
  const MapProjection map(MapProjection::zone_at({9.0, 0.001, 0.0}));
  EXPECT_LT(map.to_map({9.0, -0.001, 0.0}).position.y(), 0.0);
  EXPECT_NEAR(map.to_earth(map.to_map({9.1, -0.001, 5.0}).position).latitude, -0.001, 1e-10);
}

TEST(MapProjection, SaysWhatCannotBeMeant) {
  const MapProjection map(MapProjection::zone_at({11.0, 48.0, 0.0}));
  EXPECT_EQ(map.refusal({11.5, 48.1, 0.0}), "");
  EXPECT_NE(map.refusal({11.0, -48.0, 0.0}), "");
  EXPECT_NE(map.refusal({-105.0, 40.0, 0.0}), "");
  EXPECT_NE(map.refusal({11.0, NAN, 0.0}), "");
  const MapProjection local({Projection::kLocal, 0, true, 48.0, 11.0, 500.0});
  EXPECT_EQ(local.refusal({11.5, 48.1, 0.0}), "");
  EXPECT_NE(local.refusal({11.0, -48.0, 0.0}), "");
}

TEST(MapProjection, ALocalMapIsItsPlane) {
  const GeoPoint origin{-105.0, 40.0, 1600.0};
  const MapProjection map({Projection::kLocal, 0, true, origin.latitude, origin.longitude, origin.altitude});
  EXPECT_LT(map.to_map(origin).position.norm(), 1e-7);
  const Eigen::Vector3d position(2000.0, 500.0, 3.0);
  const MapPlace place = map.to_map(map.to_earth(position));
  EXPECT_LT((place.position - position).norm(), 1e-7);
  EXPECT_NEAR((place.map_from_local * Eigen::Vector3d::UnitZ()).x(), 2000.0 / 6.386e6, 1e-6);
}

}  // namespace
}  // namespace relative_map::core
