#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/motion/dead_reckoning.hpp"
#include "relative_map/pipeline/motion/heading_witness.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/pose_buffer.hpp"
#include "relative_map/pipeline/motion/stamp_order.hpp"

namespace relative_map::core {

/// The newest localization and chassis, looked at, and the poses that they tell: where the vehicle is, and
/// how it moves.
class MotionInputs {
 public:
  /// What a localization has changed.
  struct News {
    bool dropped = false;          ///< by its stamp (StampOrder), and nothing has changed
    bool time_went_back = false;   ///< what was known is of another time, and forgotten
    bool moved = false;            ///< there is a new pose
    bool odometry_failed = false;  ///< speed or yaw rate have turned out to be wrong
    std::vector<std::string> remarks;
  };

  /// Of the link whose place in the vehicle `link_from_base` gives; none: of the body frame itself.
  /// `received`: when it came, by the clock; none: not known.
  News take(const Localization& link, const std::optional<Eigen::Isometry3d>& link_from_base,
            const MaxAgeParam& max_age, std::optional<Time> received);
  /// Returns a sentence if it is dropped, and for each number that was repaired.
  std::vector<std::string> take(const Chassis& chassis, const MaxAgeParam& max_age,
                                std::optional<Time> received);
  void reset() { *this = MotionInputs(); }

  /// The stamp of the newest localization; none: there is none yet.
  std::optional<Time> stamp() const;
  const PoseBuffer& poses() const { return poses_; }
  /// How the vehicle moved, whatever localization says of where it is.
  const DeadReckoning& dead_reckoning() const { return dead_reckoning_; }
  /// As localized, at the time of the newest pose, or why there is no telling. What was noticed about the
  /// inputs goes to `remarks`.
  std::variant<VehicleState, Status> vehicle(Time now, const MaxAgeParam& max_age,
                                             std::vector<std::string>& remarks) const;
  /// `vehicle`, a place of the newest pose's time, carried on to `now` by odometry.
  VehicleState carried_to(Time now, VehicleState vehicle) const;

 private:
  /// A stamp that is too far ahead to be believed.
  struct Ahead {
    Time received{};
    std::string sentence;
  };

  std::optional<Chassis> fresh_chassis(Time now, const MaxAgeParam& max_age) const;
  void doubt_zeros();
  KnownMotion known_motion(const MaxAgeParam& max_age) const;
  void look_at_direction(const Localization& link, const std::optional<Eigen::Isometry3d>& link_from_base,
                         const MaxAgeParam& max_age);

  StampOrder localization_order_{"localization"}, chassis_order_{"chassis"};
  std::optional<Ahead> ahead_;  ///< the newest one

  std::optional<Checked<Localization>> localization_;  ///< of the body frame
  std::optional<Checked<Chassis>> chassis_;
  HeadingWitness witness_;
  // A velocity of exactly 0 is a value, unless the vehicle has come away and no other was ever given.
  std::optional<Point2> start_;
  bool came_away_ = false, velocity_filled_ = false;
  std::optional<bool> by_orientation_;  ///< the direction that was believed last
  PoseBuffer poses_;
  DeadReckoning dead_reckoning_;
};

}  // namespace relative_map::core
