#pragma once

#include <cmath>
#include <optional>
#include <string>

#include "relative_map/geometry/kalman_filter.hpp"
#include "relative_map/model/sensor_noise.hpp"
#include "relative_map/pipeline/estimation/offset_profile.hpp"
#include "relative_map/pipeline/lines/line_walker.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

/// The fine part of the lane estimate: an extended Kalman filter over where the vehicle is in the map frame,
/// what is wrong with its sensors, how wide the lane is, and by how much it lies beside its recorded line.
///
/// Odometry moves the pose. Localization measures pose plus bias. Paint measures the lane's border. Which
/// border a marker is, and whether it is to be believed at all, is decided outside.
class LaneFilter {
 public:
  enum State {
    kYawRateBias,   ///< [rad/s] the gyroscope shows too much by
    kSpeedScale,    ///< [-] the vehicle is faster than told by
    kX,             ///< [m] from the origin
    kY,             ///< [m]
    kHeading,       ///< [rad]
    kBiasX,         ///< [m] localization lies to the east by
    kBiasY,         ///< [m] ... to the north by
    kBiasHeading,   ///< [rad]
    kCameraOffset,  ///< [m] the camera is to the left of where it is thought to be
    kCameraYaw,     ///< [rad] it looks to the left of where it is thought to look
    kHalfWidth,     ///< [m] of the lane
    kRecording,     ///< [m] the lane is to the left of its line by, all along
    kFirstKnot      ///< [m] ... and here, besides: OffsetProfile
  };
  static constexpr int kStates = kFirstKnot + OffsetProfile::kKnots;
  enum class Side { kLeft, kRight };

  /// One marker taken for one border: where the paint is, less where the border is expected (left positive),
  /// as the polynomial that a camera makes of it; with its Jacobian, and what is to be expected of it.
  struct Measurement {
    PaintTerms innovation;
    Eigen::Matrix<double, kPaintTerms, kStates> jacobian;
    Eigen::Matrix<double, kPaintTerms, kPaintTerms> covariance;
    KalmanFilter<kStates>::Expected<kPaintTerms> expected;
    double squared_distance = 0.0;

    /// [m] at the near end of the paint.
    double near_offset() const { return innovation[0]; }
    double near_stddev() const { return std::sqrt(expected.covariance(0, 0)); }
  };

  /// At `localized`, of which all but the bias is believed.
  LaneFilter(const SensorNoise& noise, const VehicleState& localized, double half_width, double sway);

  /// From one pose's time to the next, by speed and yaw rate. `position_walk` [m/sqrt(s)] of localization's
  /// bias, which decays in `decay_time` [s]; where no paint is seen, the lane's width goes back to what is
  /// expected in that time, too.
  void move(const VehicleState& from, const VehicleState& to, double position_walk, double decay_time,
            bool unseen);
  /// `position_stddev` [m] and `heading_stddev` [rad]: white noise of this pose. A pose that cannot be is a
  /// jump of localization, and becomes bias: vehicles do not jump.
  void localize(const VehicleState& localized, double position_stddev, double heading_stddev);

  /// The line that the vehicle is on, and how far along [m]. On another line than before, offsets are unknown
  /// again.
  void follow(const NavigationLine& line, double s);
  const std::string& line_id() const { return line_id_; }
  /// Paint taken for the border of the lane on that side; none where no line is beside it. `scale`: of the
  /// camera's noise.
  std::optional<Measurement> measure(const PaintSamples& paint, Side side, const NavigationLine& line,
                                     std::size_t vertex, double scale) const;
  void correct(const Measurement& measurement) {
    filter_.correct(measurement.innovation, measurement.expected);
  }
  /// The vehicle is `by` [m] to the left (`normal`) of where it was thought to be, known to `stddev` [m]: it
  /// is localization's bias that was another one.
  void shift(const Point2& normal, double by, double stddev);

  /// [m] of recordings, for places that come.
  void set_sway(double sway) { sway_ = sway; }

  bool sound() const { return filter_.sound(); }
  Pose2 pose() const { return {origin_ + Point2(state()[kX], state()[kY]), state()[kHeading]}; }
  const Point2& origin() const { return origin_; }
  const Eigen::Matrix<double, kStates, 1>& state() const { return filter_.state(); }
  const Eigen::Matrix<double, kStates, kStates>& covariance() const { return filter_.covariance(); }
  Estimate half_width() const { return {state()[kHalfWidth], filter_.stddev(kHalfWidth)}; }
  /// [m] of the lane from its line, at a place in knots: the whole of it.
  class Offsets {
   public:
    double at(double place) const { return recording_ + profile_.at(place); }

   private:
    friend class LaneFilter;
    explicit Offsets(const Eigen::Matrix<double, kStates, 1>& x)
        : recording_(x[kRecording]), profile_(x.tail<OffsetProfile::kKnots>()) {}
    double recording_;
    OffsetProfile profile_;
  };
  Offsets offsets() const { return Offsets(state()); }
  /// Place in the profile, in knots from the first one, of what is `s` [m] along the line.
  double knots_at(const NavigationLine& line, double s) const {
    return (s_along(line, s) - first_knot_s_) / OffsetProfile::kSpacing;
  }
  /// [m] of the lane from the line at the vehicle, and the standard deviation of the vehicle's place beside
  /// that lane; `normal` to the left of the line.
  Estimate lateral(const Point2& normal) const;

 private:
  Measurement fit(const PaintSamples& paint, const SampleValues& residual,
                  const Eigen::Matrix<double, kPaintSamples, kStates>& jacobian, int seen,
                  double scale) const;
  double s_along(const NavigationLine& line, double s) const;

  KalmanFilter<kStates> filter_;
  SensorNoise noise_;
  double sway_;                 ///< [m]
  double expected_half_width_;  ///< [m] where paint tells nothing
  Point2 origin_;               ///< [m] map coordinates that kX and kY are relative to
  std::string line_id_;
  double line_s_ = 0.0;        ///< [m] of the vehicle along the line, laps counted on
  double first_knot_s_ = 0.0;  ///< [m] the same for the first knot
  double last_s_ = 0.0;        ///< [m] of the vehicle, as given
};

}  // namespace relative_map::core
