#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "doctor_text.hpp"
#include "relative_map/doctor/doctor.hpp"
#include "relative_map/pipeline/lines/navigation_lines.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"

// The rules of the doctor, by what they look at, and what they share. See doctor.cpp for their list.
namespace relative_map::doctor {

using Findings = std::vector<Finding>;

inline Finding ok(std::string what) {
  return {Severity::kOk, std::move(what), "", ""};
}
inline Finding note(std::string what, std::string mend) {
  return {Severity::kNote, std::move(what), std::move(mend), ""};
}
inline Finding wrong(std::string what, std::string mend) {
  return {Severity::kWrong, std::move(what), std::move(mend), ""};
}

/// A localization message in numbers; NaN: not given.
struct PoseSample {
  double time = 0.0;                             ///< [s] of its stamp, from the first message's receipt
  core::Point2 position = core::Point2::Zero();  ///< [m] of the localized link, from the first one's
  double heading = 0.0;                          ///< [rad] pose.heading, ccw from east
  double orientation = 0.0;                      ///< [rad] yaw of pose.orientation as the node reads it
  core::Point2 velocity = core::Point2::Zero();  ///< [m/s] pose.linear_velocity
  double yaw_rate = 0.0;                         ///< [rad/s] pose.angular_velocity_vrf.z
};

/// A stretch that the localized link moved, long enough to have a direction.
struct Leg {
  double course = 0.0;                           ///< [rad] where to, ccw from east
  double heading = 0.0, orientation = 0.0;       ///< [rad] on the way, as in PoseSample
  double distance = 0.0;                         ///< [m]
  double duration = 0.0;                         ///< [s] above 0
  core::Point2 velocity = core::Point2::Zero();  ///< [m/s] on the way, as in PoseSample
};

/// The observations, and what several rules make of them.
struct Evidence {
  explicit Evidence(const Observations& observations);

  const Observations& seen;
  std::vector<PoseSample> poses;
  std::vector<Leg> legs;
  std::shared_ptr<const core::NavigationLines> lines;  ///< of the newest navigation message; null: none came
  std::optional<core::VehicleState> vehicle;           ///< of the newest pose that can be used
  std::vector<std::string> refused_poses;              ///< why the node can't use a pose, a sentence each
  bool reversing = false;                              ///< by the gear, most of the time

  /// Whether the heading was 0 all the time although the vehicle points elsewhere.
  bool heading_is_never_filled() const;
  /// A heading that is no angle in radians; none: all are.
  std::optional<double> heading_not_in_radians() const;
  /// Whether there is a point in comparing the heading with others.
  bool heading_is_an_angle() const { return !heading_is_never_filled() && !heading_not_in_radians(); }
};

/// A mean direction and how far single ones are from it [rad]; NaN if there are none.
struct MeanDirection {
  double mean;
  double spread;
};
MeanDirection mean_direction(const std::vector<double>& angles);
/// NaN of none; NaN values are left out.
double median(std::vector<double> values);

/// The frame of a message, the body frame if it names none.
std::string link_of(const std::string& frame_id, const std::string& base_frame);

Findings configuration_is_accepted(const Evidence& evidence);
Findings clock_runs(const Evidence& evidence);

Findings topics_have_publishers(const Evidence& evidence);
Findings publishers_answer(const Evidence& evidence);
Findings types_are_right(const Evidence& evidence);
Findings definitions_are_the_same(const Evidence& evidence);
Findings topics_have_one_publisher(const Evidence& evidence);
Findings map_node_listens(const Evidence& evidence);
Findings messages_arrive(const Evidence& evidence);

Findings rates_are_high_enough(const Evidence& evidence);
Findings inputs_do_not_pause(const Evidence& evidence);
Findings stamps_are_filled(const Evidence& evidence);
Findings stamps_are_fresh(const Evidence& evidence);
Findings stamps_are_not_ahead(const Evidence& evidence);
Findings stamps_rise(const Evidence& evidence);

Findings map_frames_agree(const Evidence& evidence);
Findings localized_link_is_known(const Evidence& evidence);
Findings marker_frame_is_known(const Evidence& evidence);
Findings marker_frame_is_flu(const Evidence& evidence);

Findings poses_are_usable(const Evidence& evidence);
Findings heading_is_filled(const Evidence& evidence);
Findings heading_is_in_radians(const Evidence& evidence);
Findings orientation_fits_heading(const Evidence& evidence);
Findings heading_fits_motion(const Evidence& evidence);
Findings velocity_fits_motion(const Evidence& evidence);
Findings yaw_rate_fits_motion(const Evidence& evidence);
Findings speeds_agree(const Evidence& evidence);

Findings lines_are_usable(const Evidence& evidence);
Findings a_line_is_near(const Evidence& evidence);
Findings a_line_runs_along(const Evidence& evidence);

Findings markers_are_not_mirrored(const Evidence& evidence);
Findings markers_make_a_lane(const Evidence& evidence);
Findings marker_quality_is_a_share(const Evidence& evidence);
Findings marker_curvature_is_halved(const Evidence& evidence);

Findings maps_have_lanes(const Evidence& evidence);
Findings maps_keep_the_contract(const Evidence& evidence);
Findings maps_come_often_enough(const Evidence& evidence);

}  // namespace relative_map::doctor
