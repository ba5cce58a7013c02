#include "relative_map/localization/geodesy/earth.hpp"

#include <cmath>

namespace relative_map::core {

namespace {

// WGS 84 (NIMA TR8350.2): what the ellipsoid and its gravity are defined by.
constexpr double kSemiMajorAxis = 6378137.0;            // [m]
constexpr double kFlattening = 1.0 / 298.257223563;     // [-]
constexpr double kGravityAtEquator = 9.7803253359;      // [m/s^2]
constexpr double kSomigliana = 0.00193185265241;        // [-]
constexpr double kSquaredEccentricity = 0.00669437999;  // [-]
constexpr double kCentrifugalRatio = 0.00344978650684;  // [-] of centrifugal to gravitational force
constexpr double kEarthRate = 7.292115e-5;              // [rad/s]

}  // namespace

double normal_gravity(double latitude, double height) {
  const double sine = std::sin(latitude), squared = sine * sine;
  const double on_ellipsoid =
      kGravityAtEquator * (1.0 + kSomigliana * squared) / std::sqrt(1.0 - kSquaredEccentricity * squared);
  const double h = height / kSemiMajorAxis;
  return on_ellipsoid *
         (1.0 - 2.0 * (1.0 + kFlattening + kCentrifugalRatio - 2.0 * kFlattening * squared) * h +
          3.0 * h * h);
}

Eigen::Vector3d earth_rate_enu(double latitude) {
  return kEarthRate * Eigen::Vector3d(0.0, std::cos(latitude), std::sin(latitude));
}

}  // namespace relative_map::core
