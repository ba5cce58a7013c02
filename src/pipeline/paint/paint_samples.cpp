#include "relative_map/pipeline/paint/paint_samples.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

// Standard deviations of a marker of quality 1.
constexpr double kOffset = 0.05;     // [m]
constexpr double kSlope = 0.003;     // [-]
constexpr double kCurvature = 6e-5;  // [1/m] of c2
constexpr double kPoint = 0.02;      // [m] what a cubic does not follow
// Of a camera that fits straight lines, where the lane bends.
constexpr double kStraightCurvature = 0.02;  // [1/m] of c2
constexpr double kStraightReach = 5.0;       // [m]

// Paint beyond these is not the vehicle's own lane's.
constexpr double kFarthest = 10.0;     // [m] beside the vehicle
constexpr double kSteepest = 5.0;      // [-] slope
constexpr double kMaxCurvature = 0.2;  // [1/m]

using Distances = Eigen::Matrix<double, kPaintSamples, 1>;  // [m] from the camera

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

/// Of a marker's points: its error is that of its coefficients.
Eigen::Matrix<double, kPaintSamples, kPaintSamples> covariance_at(const Distances& x, double curvature,
                                                                  double quality) {
  const Distances one = x.Ones(), x2 = x.cwiseAbs2();
  Eigen::Matrix<double, kPaintSamples, kPaintSamples> covariance =
      kOffset * kOffset * one * one.transpose() + kSlope * kSlope * x * x.transpose() +
      curvature * curvature * x2 * x2.transpose();
  covariance.diagonal().array() += kPoint * kPoint;
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

PaintSamples sample_paint(const LaneMarker& marker, const Pose2& base_from_sensor) {
  PaintSamples samples;
  samples.type = marker.type;
  Distances x;
  for (int i = 0; i < kPaintSamples; ++i) {
    x[i] = marker.longitude_start + (marker.view_range - marker.longitude_start) * i / (kPaintSamples - 1);
    samples.points[static_cast<std::size_t>(i)] =
        base_from_sensor.to_parent(Point2(x[i], marker.cubic.value(x[i])));
  }
  samples.from = samples.points.front().x();
  samples.to = samples.points.back().x();
  samples.straight = marker.cubic.c2 == 0.0 && marker.cubic.c3 == 0.0;
  samples.quality = marker.quality;
  samples.covariance = covariance_at(x, kCurvature, marker.quality);
  return samples;
}

PaintSamples near_part(const PaintSamples& straight) {
  PaintSamples samples = straight;
  const Point2 first = straight.points.front(), way = straight.points.back() - first;
  const double share = std::min(1.0, kStraightReach / way.norm());
  Distances x;
  for (int i = 0; i < kPaintSamples; ++i) {
    const double part = share * i / (kPaintSamples - 1);
    samples.points[static_cast<std::size_t>(i)] = first + part * way;
    x[i] = part * way.norm();
  }
  samples.to = samples.points.back().x();
  samples.covariance = covariance_at(x, kStraightCurvature, straight.quality);
  return samples;
}

}  // namespace relative_map::core
