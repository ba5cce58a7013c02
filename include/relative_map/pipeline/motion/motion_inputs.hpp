#pragma once

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "relative_map/model/config.hpp"
#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/pose_buffer.hpp"

namespace relative_map::core {

/// The newest localization and chassis, looked at, and the poses that they tell: where the vehicle is, and
/// how it moves.
class MotionInputs {
 public:
  /// What a localization has changed.
  struct News {
    bool late = false;             ///< it is older than what is known, and dropped
    bool time_went_back = false;   ///< what was known is of another time, and forgotten
    bool moved = false;            ///< there is a new pose
    bool odometry_failed = false;  ///< speed or yaw rate have turned out to be wrong
    std::vector<std::string> remarks;
  };

  /// Of the link whose place in the vehicle `link_from_base` gives; none: of the body frame itself.
  News take(const Localization& link, const std::optional<Eigen::Isometry3d>& link_from_base,
            const MaxAgeParam& max_age);
  /// Returns a sentence for each number that was repaired.
  std::vector<std::string> take(const Chassis& chassis);
  void reset() { *this = MotionInputs(); }

  /// The stamp of the newest localization; none: there is none yet.
  std::optional<Time> stamp() const;
  const PoseBuffer& poses() const { return poses_; }
  /// As localized, at the time of the newest pose, or why there is no telling. What was noticed about the
  /// inputs goes to `remarks`.
  std::variant<VehicleState, Status> vehicle(Time now, const MaxAgeParam& max_age,
                                             std::vector<std::string>& remarks) const;
  /// `vehicle`, a place of the newest pose's time, carried on to `now` by odometry.
  VehicleState carried_to(Time now, VehicleState vehicle) const;

 private:
  std::optional<Chassis> fresh_chassis(Time now, const MaxAgeParam& max_age) const;

  std::optional<Checked<Localization>> localization_;  ///< of the body frame
  std::optional<Checked<Chassis>> chassis_;
  PoseBuffer poses_;
};

}  // namespace relative_map::core
