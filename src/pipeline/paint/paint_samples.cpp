#include "relative_map/pipeline/paint/paint_samples.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kPoint = 0.05;          // [m] of each point of the paint that the camera has seen
constexpr double kCurvatureRate = 5e-7;  // [1/m^2] of c3
constexpr double kStraight = 0.02;       // [m] by which a cubic bends that tells of no curvature

// Paint beyond these is not the vehicle's own lane's.
constexpr double kFarthest = 10.0;     // [m] beside the vehicle
constexpr double kSteepest = 5.0;      // [-] slope
constexpr double kMaxCurvature = 0.2;  // [1/m]

constexpr double kStart = -2.0;  // [m] x from which on, behind the vehicle, it must be drivable
constexpr double kStep = 1.0;    // [m]

/// Whether a vehicle could follow the cubic from the first sample to `x_end`; not if a number is NaN.
bool drivable(const Cubic& cubic, double x_end) {
  if (!(std::abs(cubic.c0) <= kFarthest)) return false;
  for (double x = kStart; x <= x_end; x += kStep) {
    if (!(std::abs(cubic.slope(x)) <= kSteepest) || !(std::abs(cubic.kappa(x)) <= kMaxCurvature))
      return false;
  }
  return true;
}

/// Of the terms of c(start + length t), where those of c(x) are off by `noise`.
Eigen::Matrix4d covariance_of(double start, double length, const CameraNoise& noise, double quality) {
  Eigen::Matrix4d shifted;  // powers of x by powers of t
  const double a = start, l = length;
  shifted << 1.0, a, a * a, a * a * a,       //
      0.0, l, 2.0 * a * l, 3.0 * a * a * l,  //
      0.0, 0.0, l * l, 3.0 * a * l * l,      //
      0.0, 0.0, 0.0, l * l * l;
  const Eigen::Vector4d stddev(noise.offset, noise.slope, noise.curvature, kCurvatureRate);
  const auto& powers = sample_powers();
  const Eigen::Matrix4d points = (powers.transpose() * powers).inverse();
  const Eigen::Matrix4d covariance =
      shifted * stddev.cwiseAbs2().asDiagonal() * shifted.transpose() + kPoint * kPoint * points;
  return covariance / (quality * quality);
}

}  // namespace

std::optional<std::string> fault_of(const LaneMarker& marker, const NavigationLaneParam& param) {
  std::ostringstream fault;
  if (!(marker.quality >= param.min_lane_marker_quality) || !(marker.quality > 0.0)) {
    fault << "quality is " << marker.quality;
  } else if (!std::isfinite(marker.view_range) ||
             marker.view_range < param.min_view_range_to_use_lane_marker) {
    fault << "view_range is " << marker.view_range << " m";
  } else if (!(marker.longitude_start < marker.view_range) || !std::isfinite(marker.longitude_start)) {
    fault << "longitude_start is " << marker.longitude_start << " m, and view_range " << marker.view_range
          << " m";
  } else if (!drivable(marker.cubic, std::min(marker.view_range, param.max_len_for_navigation_lane))) {
    const Cubic& c = marker.cubic;
    fault << "no vehicle could follow c0..c3 = " << c.c0 << ", " << c.c1 << ", " << c.c2 << ", " << c.c3;
  } else {
    return std::nullopt;
  }
  return fault.str();
}

const Eigen::Matrix<double, kPaintSamples, kPaintTerms>& sample_powers() {
  static const auto kPowers = [] {
    Eigen::Matrix<double, kPaintSamples, kPaintTerms> powers;
    for (int i = 0; i < kPaintSamples; ++i) {
      const double t = static_cast<double>(i) / (kPaintSamples - 1);
      powers.row(i) << 1.0, t, t * t, t * t * t;
    }
    return powers;
  }();
  return kPowers;
}

Eigen::Matrix<double, kPaintTerms, kPaintSamples> least_squares(int degree, int count) {
  const int terms = std::min({degree + 1, count, kPaintTerms});
  const Eigen::MatrixXd powers = sample_powers().topLeftCorner(count, terms);
  Eigen::Matrix<double, kPaintTerms, kPaintSamples> fit = fit.Zero();
  fit.topLeftCorner(terms, count) = (powers.transpose() * powers).ldlt().solve(powers.transpose());
  return fit;
}

PaintSamples sample_paint(const LaneMarker& marker, const Pose2& base_from_sensor, const CameraNoise& noise) {
  PaintSamples samples;
  samples.type = marker.type;
  const double length = marker.view_range - marker.longitude_start;
  for (int i = 0; i < kPaintSamples; ++i) {
    const double x = marker.longitude_start + length * i / (kPaintSamples - 1);
    samples.points[static_cast<std::size_t>(i)] =
        base_from_sensor.to_parent(Point2(x, marker.cubic.value(x)));
  }
  samples.from = samples.points.front().x();
  samples.to = samples.points.back().x();
  samples.degree = marker.degree;
  const double far = marker.view_range;
  samples.straight = std::abs(marker.cubic.c2) * far * far < kStraight &&
                     std::abs(marker.cubic.c3) * far * far * far < kStraight;
  samples.covariance = covariance_of(marker.longitude_start, length, noise, marker.quality);
  return samples;
}

}  // namespace relative_map::core
