#pragma once

#include <Eigen/Core>
#include <array>
#include <optional>
#include <string>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/config.hpp"
#include "relative_map/model/inputs.hpp"

namespace relative_map::core {

constexpr int kPaintSamples = 5;  ///< of one marker, evenly from its start to its view range

/// One marker as measurements: points of the paint, and how sure they are together.
struct PaintSamples {
  BoundaryType type = BoundaryType::kUnknown;
  std::array<Point2, kPaintSamples> points;  ///< [m] in the frame of the map's pose
  Eigen::Matrix<double, kPaintSamples, kPaintSamples>
      covariance;               ///< [m^2] of the points, square to the paint
  double from = 0.0, to = 0.0;  ///< [m] x of the first and the last one
  bool straight = false;        ///< the camera tells of no curvature at all
  double quality = 1.0;
};

/// The paint of one image as seen from the body now; none: not seen, or of no use.
struct SeenSides {
  std::optional<PaintSamples> left, right;
  std::optional<PaintSamples> next_left, next_right;  ///< the borders beyond
  bool unchanged = false;                             ///< the numbers are those of the image before
};

/// Samples the paint, seen from where the image was taken: `base_from_sensor` is the marker's frame then, as
/// seen from the body now. A marker's error is that of its coefficients, so it grows with the distance, and
/// the points share it.
PaintSamples sample_paint(const LaneMarker& marker, const Pose2& base_from_sensor);

/// Of `straight` paint, what counts where the lane bends: its first few metres.
PaintSamples near_part(const PaintSamples& straight);

/// Why a marker does not count; none: it does.
std::optional<std::string> fault_of(const LaneMarker& marker, const NavigationLaneParam& param);

}  // namespace relative_map::core
