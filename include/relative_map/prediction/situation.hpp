#pragma once

#include <array>
#include <optional>
#include <vector>

#include "relative_map/prediction/lane_sequence.hpp"
#include "relative_map/prediction/road_user.hpp"

namespace relative_map::core {

/// How far along its way a road user is, how fast, and how that changes, at the prediction's times.
struct SpeedProfile {
  std::array<double, kPredictionPoints> s{};  ///< [m] from where it is now
  std::array<double, kPredictionPoints> v{};  ///< [m/s] >= 0
  std::array<double, kPredictionPoints> a{};  ///< [m/s^2]
};

/// Who drives ahead on the same way.
struct Leader {
  std::size_t index = 0;  ///< into the situations; the vehicle itself is the one past their end
  double gap = 0.0;       ///< [m] bumper to bumper
  double speed = 0.0;     ///< [m/s] along the way
};

/// A way along lanes that a road user may take.
struct LaneOption {
  explicit LaneOption(LaneSequence way) : path(std::move(way)) {}

  LaneSequence path;
  double l = 0.0;              ///< [m] from this way's own centerline
  double lateral_speed = 0.0;  ///< [m/s] left positive, against it
  double half_width = 0.0;     ///< [m] of its first lane, on the road user's side
  double turn = 0.0;           ///< [rad] within the reach of a few seconds
  double bend = 0.0;           ///< [rad] that it bends away by, more than the straightest of all ways
  double braking = 0.0;        ///< [m/s^2] that its curves ask for
  double probability = 0.0;
  std::optional<Leader> leader;

  /// Whether the road user is on it already, and not beside it.
  bool inside() const { return std::abs(l) <= half_width; }
};

/// All that is known of a road user when its future is asked for.
struct Situation {
  const RoadUser* user = nullptr;
  MotionFilter filter;                         ///< at the prediction's time
  double theta = 0.0;                          ///< [rad] where it drives to
  double speed = 0.0;                          ///< [m/s] along theta, >= 0
  double acceleration = 0.0;                   ///< [m/s^2] along theta
  double half_length = 0.0, half_width = 0.0;  ///< [m]
  std::vector<LanePlace> places;               ///< lanes around it
  std::vector<LaneOption> options;  ///< ways that it may take; the likeliest first once they are evaluated
  SpeedProfile profile;             ///< on the likeliest of them, or straight on
  Priority priority = Priority::kNormal;
  bool interactive = false;

  bool still() const { return user->still(); }
  /// Follows leaders and brakes for curves; a bicycle is beside the one and too slow for the other.
  bool drives_like_a_car() const {
    return user->type() != RoadUserType::kBicycle && user->type() != RoadUserType::kPedestrian;
  }
  Point2 position() const { return filter.position(); }
  Point2 forward() const { return {std::cos(theta), std::sin(theta)}; }
  /// The same one, as if there were no map.
  Situation without_lanes() && {
    places.clear();
    options.clear();
    return std::move(*this);
  }
  const LaneOption* best() const { return options.empty() ? nullptr : &options.front(); }
  /// [m] from its middle to its border, seen from another direction
  double half_extent(double direction) const {
    const double angle = direction - theta;
    return std::abs(std::cos(angle)) * half_length + std::abs(std::sin(angle)) * half_width;
  }
};

}  // namespace relative_map::core
