#pragma once

#include <Eigen/Geometry>
#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/model/inputs.hpp"
#include "relative_map/model/map.hpp"

namespace relative_map::core {

/// Where base_link is and how it moves.
struct VehicleState {
  Time stamp{};
  Pose2 map_from_base;
  double speed = 0.0;           ///< [m/s] negative when reversing; NaN: not given
  double yaw_rate = 0.0;        ///< [rad/s] NaN: not given
  bool speed_by_poses = false;  ///< the speed is how the poses have moved: no second witness beside them
  // Standard deviations by what the localization says of itself: a prior at best. NaN: not given.
  double position_stddev = std::numeric_limits<double>::quiet_NaN();  ///< [m] of x and of y
  double heading_stddev = std::numeric_limits<double>::quiet_NaN();   ///< [rad]
};

/// The pose of base_link, given that of another link of the same rigid body; the velocity gets its lever
/// arm: v_base = v_link + omega x r. Heading and orientation are those of base_link afterwards.
Localization carry_to_base(const Localization& link, const Eigen::Isometry3d& link_from_base);

/// The plane view of a pose of base_link, or INVALID_LOCALIZATION with the field and the value.
/// Speed is the chassis', else the velocity along the heading.
std::variant<VehicleState, Status> make_vehicle_state(const Localization& base,
                                                      const std::optional<Chassis>& chassis);

/// A sentence where the chassis and localization tell speeds of which one must be wrong; none: they agree, or
/// one tells nothing.
std::optional<std::string> speeds_disagree(const Localization& base, const Chassis& chassis);

/// Whether the vehicle has moved by more than its speed explains: it was put elsewhere. So it was if a place
/// is no number.
bool has_jumped(const VehicleState& before, const VehicleState& after);

/// Constant speed and yaw rate over `seconds` [s], which may be negative: the arc's chord at its mean
/// heading.
Pose2 carried_on(const VehicleState& state, double seconds);

}  // namespace relative_map::core
