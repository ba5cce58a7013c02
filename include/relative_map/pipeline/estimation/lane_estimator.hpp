#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/estimation/kalman_filter.hpp"
#include "relative_map/pipeline/estimation/offset_profile.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"
#include "relative_map/pipeline/paint/paint_samples.hpp"

namespace relative_map::core {

/// Estimates where the vehicle is beside its line, from odometry, localization and paint.
///
/// A Kalman filter over the vehicle's true pose, localization's bias, the yaw rate's bias, the direction that
/// the camera is off by, the half widths of the lane and the offset of the lane from the line along it
/// (OffsetProfile). Odometry moves the pose. Localization measures pose plus bias: what is white in it
/// averages out, and what stays becomes bias as soon as paint tells the two apart. Paint measures the
/// distance of its points from the line less the offset and the half width. On a straight that says nothing
/// about the way along the line; where the line bends, it does. A camera that looks aside shows paint that
/// the vehicle never comes nearer to.
class LaneEstimator {
 public:
  /// Odometry up to `localized`, and what localization says there.
  void move(const VehicleState& localized, const LaneFusionParam& param);
  /// The line that the vehicle is on, and where.
  void follow_line(const NavigationLine& line, const LineProjection& projection);
  /// Paint beside that line. Returns a sentence for each side that was ignored.
  std::vector<std::string> see(const SeenSides& sides, const NavigationLine& line,
                               const LineProjection& projection, Time stamp);
  /// `half_width` [m] of the lane, where nothing of it was seen yet.
  void expect_half_width(double half_width) { half_width_ = half_width; }
  /// Odometry was wrong, and with it what was made of it: forgets it all where paint will show it again,
  /// which it does not where localization is off by more than paint is believed to be.
  void doubt_motion();
  /// Forgets everything: localization is believed as it is.
  void reset() { *this = LaneEstimator(); }

  /// Whether paint has told anything that is still worth something.
  bool informed() const { return last_paint_.has_value(); }
  /// The time of the newest paint that counted.
  std::optional<Time> last_paint() const { return last_paint_; }
  /// Why the estimate was thrown away, until it is one again; empty: it was not.
  const std::string& given_up() const { return given_up_; }
  /// [m] how far ahead of the vehicle that paint reaches.
  double paint_range() const { return paint_range_; }

  BoundaryType left_paint() const { return left_paint_; }
  BoundaryType right_paint() const { return right_paint_; }
  BoundaryType next_left_paint() const { return next_left_.type; }
  BoundaryType next_right_paint() const { return next_right_.type; }

  /// Where the vehicle is: `localized` without what is known to be wrong with it.
  VehicleState corrected(const VehicleState& localized) const;
  /// Moves the current lane to where it is beside its line, and sets its half widths: the window of `line`
  /// around `projection`; a lane is at least as wide as the vehicle. Returns whether it did: not without
  /// anything known of this line.
  bool apply(const NavigationLine& line, const LineProjection& projection, double least_half_width,
             LanePath& lane) const;
  /// Tells the lanes beside the current one, `lanes[current]`, where their far borders are, if paint showed
  /// it.
  void apply_beside(std::vector<LanePath>& lanes, std::size_t current) const;
  FusionState state(const LineProjection& projection, double heading) const;

 private:
  enum Index {
    kTurnBias,
    kX,
    kY,
    kHeading,
    kBiasX,
    kBiasY,
    kBiasHeading,
    kLeft,
    kRight,
    kCameraYaw,
    kFirstKnot
  };
  static constexpr int kStates = kFirstKnot + OffsetProfile::kKnots;
  using Filter = KalmanFilter<kStates>;
  template <int Rows>
  using Jacobian = Eigen::Matrix<double, Rows, kStates>;
  /// Of one marker, seen as one side of the lane.
  struct Measurement {
    Eigen::Matrix<double, kPaintSamples, 1> innovation;  ///< [m]
    Jacobian<kPaintSamples> jacobian;
    Eigen::Matrix<double, kPaintSamples, kPaintSamples> covariance;
    Filter::Expected<kPaintSamples> expected;
    double squared_distance = 0.0;

    Eigen::Matrix<double, kPaintSamples, 1> weights() const;  ///< of the samples in their mean
    double mean_offset() const { return weights().dot(innovation); }
  };

  /// One border of the lane, and the marker that it is taken for.
  struct SeenSide {
    Index side;
    const char* name;  ///< of the marker
    std::optional<PaintSamples> paint;
    std::optional<Measurement> measurement;
  };
  /// An offset that paint insists on.
  struct Surprise {
    double offset;  ///< [m]
    Time since;
  };

  /// A border beyond those of the lane: its distance from the lane's center [m], a filter of its own.
  struct NextBorder {
    KalmanFilter<1> distance;
    bool known = false;
    BoundaryType type = BoundaryType::kUnknown;  ///< in the newest image
  };
  void see_next(const std::optional<PaintSamples>& paint, Index side, const NavigationLine& line,
                std::size_t vertex, NextBorder& border);
  /// What is remembered of the stream of images, whatever becomes of the estimate.
  struct Watch {
    std::optional<Time> begun;  ///< since when paint has come that may be believed
    bool refused = false;       ///< paint, and none was believed since
    Time last_image{};          ///< of it
    double max_offset = 0.0;    ///< [m] LaneFusionParam
    bool frozen = false;        ///< paint has not changed, though the line has
    std::string line_id;
    Eigen::Vector2d line_shape =
        Eigen::Vector2d::Zero();  ///< [rad] that line's directions, when paint last changed
  };

  void start(const VehicleState& localized);
  void give_up(const VehicleState& localized, const std::string& why);
  void listen(const VehicleState& localized);
  void decay(double kept);
  void follow_odometry(const VehicleState& to, double dt);
  void follow_localization(const VehicleState& localized);
  double s_along(const NavigationLine& line, double s) const;
  std::optional<Measurement> measure(const PaintSamples& paint, Index side, const NavigationLine& line,
                                     std::size_t vertex) const;
  bool fits(const Measurement& measurement) const;
  bool is_opening(const std::array<SeenSide, 2>& seen) const;
  double mean_stddev(const Measurement& measurement) const;
  void measure_again(SeenSide& one, const NavigationLine& line, const LineProjection& projection) const;
  std::optional<PaintSamples> credible(const std::optional<PaintSamples>& paint, const NavigationLine& line,
                                       std::size_t vertex) const;
  /// The sides, the surer one first.
  std::array<SeenSide, 2> assign(const SeenSides& sides, const NavigationLine& line,
                                 const LineProjection& projection) const;
  /// Leaves a sentence in `ignored` for each side that does not fit.
  bool may_begin(const std::array<SeenSide, 2>& seen, Time stamp, std::vector<std::string>& ignored);
  static std::string refusal_of(const SeenSide& side);
  bool is_frozen(const SeenSides& sides, const NavigationLine& line, const LineProjection& projection);
  /// What to make of paint of which nothing fits.
  void reconsider(const std::array<SeenSide, 2>& seen, Time stamp);
  void doubt_bias(double variance);

  Filter filter_;
  std::optional<VehicleState> last_;  ///< as localized
  Point2 origin_ = Point2::Zero();    ///< [m] map coordinates that kX and kY are relative to
  std::string line_id_;
  double line_s_ = 0.0;        ///< [m] of the vehicle along the line, laps counted on
  double first_knot_s_ = 0.0;  ///< [m] the same for the first knot
  double last_projected_s_ = 0.0;
  double position_variance_ = 0.0;  ///< [m^2] of localization, white from message to message
  double heading_variance_ = 0.0;   ///< [rad^2] likewise
  double half_width_ = 1.75;        ///< [m] expected where paint tells nothing
  std::optional<Time> last_paint_, refused_since_;
  std::optional<Surprise> surprise_;
  bool doubted_ = false;  ///< since refused_since_
  Watch watch_;
  NextBorder next_left_, next_right_;
  double paint_range_ = 0.0;
  std::string given_up_;
  BoundaryType left_paint_ = BoundaryType::kUnknown, right_paint_ = BoundaryType::kUnknown;
};

}  // namespace relative_map::core
