#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/config.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/model/sensor_noise.hpp"

namespace relative_map::core {

constexpr int kPaintSamples = 8;  ///< of one marker, evenly from its start to its view range
constexpr int kPaintTerms = 4;    ///< numbers that a cubic has

/// Values at the samples.
using SampleValues = Eigen::Matrix<double, kPaintSamples, 1>;
/// A cubic through them, as powers of t: 0 at the first sample and 1 at the last one.
using PaintTerms = Eigen::Matrix<double, kPaintTerms, 1>;

/// One marker as a measurement: a cubic that a camera has laid through paint, by least squares over what it
/// sees.
struct PaintSamples {
  BoundaryType type = BoundaryType::kUnknown;
  std::array<Point2, kPaintSamples> points;  ///< [m] of the cubic, in the frame of the map's pose
  Eigen::Matrix<double, kPaintTerms, kPaintTerms> covariance;  ///< [m^2] of its terms
  double from = 0.0, to = 0.0;                                 ///< [m] x of the first and the last point
  int degree = 3;                                              ///< of the polynomial
  bool straight = false;                                       ///< it tells of no curvature at all
};

/// What turns values at samples into the polynomial that fits them best; what it can't follow is lost, for
/// the camera's as for ours. Only the first `count` samples count; terms beyond `degree` are 0. 2 or more
/// samples.
Eigen::Matrix<double, kPaintTerms, kPaintSamples> least_squares(int degree, int count);
/// The powers of t at each sample.
const Eigen::Matrix<double, kPaintSamples, kPaintTerms>& sample_powers();

/// The paint of one image as seen from the body now; none: not seen, or of no use.
struct SeenSides {
  std::optional<PaintSamples> left, right;
  std::optional<PaintSamples> next_left, next_right;  ///< the borders beyond
  bool unchanged = false;                             ///< the numbers are those of the image before
};

/// Samples the paint, seen from where the image was taken: `base_from_sensor` is the marker's frame then, as
/// seen from the body now.
PaintSamples sample_paint(const LaneMarker& marker, const Pose2& base_from_sensor, const CameraNoise& noise);

/// Why a marker does not count; none: it does.
std::optional<std::string> fault_of(const LaneMarker& marker, const NavigationLaneParam& param);

}  // namespace relative_map::core
