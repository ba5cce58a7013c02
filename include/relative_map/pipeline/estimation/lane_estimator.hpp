#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/model/map.hpp"
#include "relative_map/pipeline/estimation/lane_filter.hpp"
#include "relative_map/pipeline/estimation/localization_noise.hpp"
#include "relative_map/pipeline/estimation/neighbour_borders.hpp"
#include "relative_map/pipeline/estimation/which_lane.hpp"
#include "relative_map/pipeline/lanes/lane_path.hpp"
#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"
#include "relative_map/pipeline/paint/frozen_paint.hpp"

namespace relative_map::core {

/// Estimates where the vehicle is beside its line, from odometry, localization and paint: WhichLane finds the
/// lane, LaneFilter the place in it.
class LaneEstimator {
 public:
  explicit LaneEstimator(const SensorNoise& noise = {})
      : noise_(noise),
        meter_(noise.localization),
        which_(noise.localization.position_bias + 0.5),
        sway_(noise.road.sway) {}

  /// Odometry up to `localized`, and what localization says there.
  void move(const VehicleState& localized, const LaneFusionParam& param);
  /// The line that the vehicle is on, and where. `others`: how far to the left of it other lines are [m].
  void follow_line(const NavigationLine& line, const LineProjection& projection,
                   const std::vector<double>& others);
  /// Paint beside that line. Returns a sentence for each side that was ignored.
  std::vector<std::string> see(const SeenSides& sides, const NavigationLine& line,
                               const LineProjection& projection, Time stamp);
  /// `half_width` [m] of the lane, where nothing of it was seen yet.
  void expect_half_width(double half_width) { half_width_ = half_width; }
  /// Odometry was wrong, and with it what was made of it.
  void doubt_motion();
  /// Forgets everything: localization is believed as it is.
  void reset() { *this = LaneEstimator(noise_); }

  /// Whether paint has told anything that is still worth something.
  bool informed() const { return filter_ && last_paint_; }
  /// The time of the newest paint that counted.
  std::optional<Time> last_paint() const { return last_paint_; }
  /// Why the estimate was thrown away, until it is one again; empty: it was not.
  const std::string& given_up() const { return given_up_; }
  /// [m] how far ahead of the vehicle that paint reaches.
  double paint_range() const { return paint_range_; }

  BoundaryType left_paint() const { return left_paint_; }
  BoundaryType right_paint() const { return right_paint_; }
  BoundaryType next_left_paint() const { return beyond_.left.type; }
  BoundaryType next_right_paint() const { return beyond_.right.type; }

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
  using Side = LaneFilter::Side;
  /// One marker, and the border of the lane that it is taken for.
  struct SeenSide {
    Side side;
    const char* name;  ///< of the marker
    std::optional<PaintSamples> paint;
    std::optional<LaneFilter::Measurement> measurement;
  };
  void forget_place();
  void start(const VehicleState& localized);
  void find_lane(std::array<SeenSide, 2>& seen, const NavigationLine& line, const LineProjection& projection,
                 double seconds);
  bool is_opening(const std::array<SeenSide, 2>& seen) const;
  bool fits(const SeenSide& one) const;
  void measure(SeenSide& one, const NavigationLine& line, const LineProjection& projection) const;
  std::array<SeenSide, 2> assign(const SeenSides& sides, const NavigationLine& line,
                                 const LineProjection& projection) const;
  void see_beyond(const std::optional<PaintSamples>& paint, Side side, const NavigationLine& line,
                  std::size_t vertex, Time stamp);
  void learn_sway(double way);

  SensorNoise noise_;
  LocalizationNoiseMeter meter_;
  WhichLane which_;
  std::optional<LaneFilter> filter_;
  std::optional<VehicleState> last_;  ///< as localized
  WhichLane::Road road_;
  std::string line_id_;
  Point2 normal_ = Point2::UnitY();   ///< to the left of the line, at the vehicle
  double line_l_ = 0.0;               ///< [m] of the vehicle beside its line
  double heading_offset_ = 0.0;       ///< [rad] from the line
  double way_ = 0.0, seconds_ = 0.0;  ///< [m], [s] since the last tick
  double max_offset_ = 30.0;          ///< [m] LaneFusionParam
  double half_width_ = 1.75;          ///< [m] expected where paint tells nothing
  double sway_;                       ///< [m] of recordings, as measured
  double image_scale_ = 1.0;          ///< [-] of the camera's variance, as measured
  bool lane_clear_ = false;           ///< which lane the vehicle is in
  double agreed_ = 0.0;               ///< [s] of paint that has agreed on it
  std::optional<Time> last_paint_, last_image_;
  FrozenPaint frozen_;
  NeighbourBorders beyond_;
  double paint_range_ = 0.0;
  std::string given_up_;
  BoundaryType left_paint_ = BoundaryType::kUnknown, right_paint_ = BoundaryType::kUnknown;
};

}  // namespace relative_map::core
