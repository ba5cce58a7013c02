#pragma once

#include <deque>

#include "relative_map/model/road_users.hpp"
#include "relative_map/prediction/motion_filter.hpp"

namespace relative_map::core {

/// Where it was seen.
struct PastPosition {
  Time stamp{};
  Point2 position = Point2::Zero();  ///< [m] as measured, map frame
};

/// A road user as it is remembered, in the map frame.
class RoadUser {
 public:
  RoadUser(Time stamp, const SeenRoadUser& seen, double position_stddev, const MotionFilterParam& param);

  /// A later sight of it.
  void see(Time stamp, const SeenRoadUser& seen, double position_stddev, const MotionFilterParam& param,
           double history_length);
  /// How unlikely it is that this is the same one: squared standard deviations, and [m] from where it should
  /// be.
  double surprise(Time stamp, const SeenRoadUser& seen, double position_stddev,
                  const MotionFilterParam& param) const;
  double distance_to(Time stamp, const Point2& position) const;

  const SeenRoadUser& seen() const { return seen_; }
  Time stamp() const { return stamp_; }  ///< of the last sight
  RoadUserType type() const { return type_; }
  const MotionFilter& filter() const { return filter_; }
  const std::deque<PastPosition>& history() const { return history_; }  ///< oldest first
  /// Where it drives to [rad]: its velocity's direction, at rest its box's. A box that is turned by 180
  /// degrees is the same one.
  double theta() const { return theta_; }
  bool theta_is_known() const { return theta_known_; }
  /// Along theta [m/s], >= 0 but for noise and vehicles that reverse.
  double speed() const { return filter_.velocity().norm(); }
  bool still() const { return still_; }
  bool on_wheels() const {
    return type_ != RoadUserType::kPedestrian && type_ != RoadUserType::kUnknownUnmovable;
  }
  /// The filter carried on to `now`.
  MotionFilter filter_at(Time now, const MotionFilterParam& param) const;
  double history_span() const;  ///< [s]

 private:
  void note_type(RoadUserType type);
  void note_heading(const SeenRoadUser& seen);

  SeenRoadUser seen_;
  Time stamp_;
  RoadUserType type_;
  int type_votes_ = 1;
  MotionFilter filter_;
  std::deque<PastPosition> history_;
  double theta_ = 0.0;
  bool theta_known_ = false;
  bool still_ = false;
};

}  // namespace relative_map::core
