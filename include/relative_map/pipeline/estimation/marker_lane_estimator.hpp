#pragma once

#include <optional>
#include <string>
#include <vector>

#include "relative_map/geometry/cubic.hpp"
#include "relative_map/geometry/kalman_filter.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

/// Estimates the lane ahead from paint alone: a Kalman filter over a clothoid in the body frame (Dickmanns
/// and Mysliwetz 1992), the half widths, the yaw rate's bias and the direction that the camera is off by.
/// Odometry carries it on where no paint is seen.
class MarkerLaneEstimator {
 public:
  void move(const VehicleState& localized);
  /// Returns a sentence for each side that was ignored.
  /// `half_width` [m]: what a lane has where nothing was seen yet.
  std::vector<std::string> see(const SeenSides& sides, double half_width, const NavigationLaneParam& param,
                               Time stamp);
  void reset() { *this = MarkerLaneEstimator(); }

  std::optional<Time> last_paint() const { return last_paint_; }
  /// [m] x up to which paint was seen, the way driven since taken off.
  double seen_to() const { return seen_to_; }
  BoundaryType left_paint() const { return left_paint_; }
  BoundaryType right_paint() const { return right_paint_; }
  /// The centerline y(x) in the body frame.
  Cubic centerline() const;
  Estimate left_half_width() const { return {filter_.state()[kLeft], filter_.stddev(kLeft)}; }
  Estimate right_half_width() const { return {filter_.state()[kRight], filter_.stddev(kRight)}; }

 private:
  enum Index { kOffset, kSlope, kCurvature, kCurvatureRate, kLeft, kRight, kTurnBias, kCameraYaw };
  static constexpr int kStates = 8;
  using Filter = KalmanFilter<kStates>;
  struct Measurement {
    PaintTerms innovation;
    Eigen::Matrix<double, kPaintTerms, kStates> jacobian;
  };

  void start(double half_width);
  void follow_driver(const VehicleState& vehicle, double dt);
  std::vector<std::string> correct(const SeenSides& sides, Time stamp);
  Measurement measure(const PaintSamples& paint, Index side) const;

  Filter filter_;
  std::optional<VehicleState> last_;
  std::optional<Time> last_paint_, refused_since_;
  double seen_to_ = 0.0;
  BoundaryType left_paint_ = BoundaryType::kUnknown, right_paint_ = BoundaryType::kUnknown;
};

}  // namespace relative_map::core
