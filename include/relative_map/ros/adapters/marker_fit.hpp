#pragma once

#include <nav_msgs/Path.h>
#include <relative_map/LaneMarkers.h>

#include <optional>
#include <string>

namespace relative_map {

/// A lane marker out of points of paint, and how well it fits them.
struct FittedMarker {
  LaneMarker marker;      ///< quality 0 where no cubic fits
  double residual = 0.0;  ///< [m] RMS of the points' distance in y from the cubic, from its start to its end
  double left_out = 0.0;  ///< [m] of x at the far end that no cubic fits to together with the rest
  std::string fault;      ///< why there is no marker; empty: there is
};

/// Fits y(x) = c0 + c1 x + c2 x^2 + c3 x^3 by least squares to the points ahead of the sensor (x >= 0, FLU),
/// from the nearest one as far as the RMS stays below `max_residual` [m]. The degree is what the number of
/// points allows.
FittedMarker fit_marker(const nav_msgs::Path& paint, double max_residual);

/// Puts the left and the right border of one image together: borders of equal stamp are one image. A border
/// whose other side does not come is sent alone.
class MarkerPairing {
 public:
  explicit MarkerPairing(double max_residual) : max_residual_(max_residual) {}

  struct Answer {
    std::optional<LaneMarkers> markers;
    FittedMarker fitted;  ///< of this border
  };
  Answer add(bool is_left, const nav_msgs::Path& paint, const ros::Time& received);

 private:
  double max_residual_;
  std::optional<LaneMarkers> waiting_;  ///< has one side
  bool waits_for_left_ = false;
  ros::Time newest_[2];  ///< [s] when the left and the right side came
};

}  // namespace relative_map
