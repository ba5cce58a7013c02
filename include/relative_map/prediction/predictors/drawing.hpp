#pragma once

#include <functional>

#include "relative_map/prediction/context.hpp"

namespace relative_map::core {

/// How the lateral offset from a way's centerline goes on.
class LateralMove {
 public:
  /// Stays on the lane: the offset fades over `time` [s], the lateral speed `rate` [m/s] within a second.
  static LateralMove keep(double l, double rate, double time);
  /// Goes over to the centerline within `time` [s] along a cubic, and stays there.
  static LateralMove change(double l, double rate, double time);

  /// [m] now
  double offset() const;
  /// Goes on by a share of the prediction's step: what hardly drives hardly moves sideways.
  void advance(double share);

 private:
  double l_ = 0.0, rate_ = 0.0, time_ = 0.0;
  bool keeps_ = true;
  double passed_ = 0.0;                         ///< [s]
  double offset_fade_ = 1.0, rate_fade_ = 1.0;  // what is left, by now
  double offset_factor_ = 1.0;
};

/// How much of it the standard deviations along and across are at the prediction's times [m].
struct Spread {
  std::array<double, kPredictionPoints> along{}, across{};
};
/// What is not known now, carried on at its speed, and what its road user may do from now on.
Spread spread_of(const Situation& situation, const SpreadParam& param);

/// Along a way, from where the road user is.
PredictedTrajectory draw_on_way(const Situation& situation, const LaneOption& option,
                                const SpeedProfile& profile, LateralMove lateral, const Spread& spread);

/// Along a curve that is given by its points at the prediction's times. Theta is that of the points.
PredictedTrajectory draw_points(const std::array<Point2, kPredictionPoints>& positions, double theta,
                                const Spread& spread);

/// The lane that a road user is on after 3 s, which is when a lane has been chosen.
std::string lane_after_choice(const LaneOption& option, const SpeedProfile& profile);

}  // namespace relative_map::core
