#include <algorithm>
#include <utility>

#include "doctor_system.hpp"

// What can be wrong with the vehicle's pose and motion, the lines, the paint and the maps.
namespace relative_map::doctor::test {

namespace {

using core::kPi;
using relative_map::test::kNaN;
using relative_map::test::quaternion;
using relative_map::test::yaw;

template <class Change>
void change_pose(Observations& seen, Change change_one) {
  change(seen.localization, [&](LocalizationEstimate& message) { change_one(message.pose); });
}

template <class Change>
void change_points(Observations& seen, Change change_one) {
  change(seen.navigation, [&](NavigationInfo& info) { change_one(info.navigation_path[0].path.path_point); });
}

template <class Change>
void change_each_point(Observations& seen, Change change_one) {
  change_points(
      seen, [&](std::vector<PathPoint>& points) { std::for_each(points.begin(), points.end(), change_one); });
}

void set_speed(Observations& seen, double speed) {
  change(seen.chassis, [&](Chassis& chassis) { chassis.speed_mps = speed; });
}

void turn_orientation(Observations& seen, double angle) {
  change_pose(seen, [&](Pose& pose) { pose.orientation = quaternion(yaw(pose.heading + angle)); });
}

/// In both of its places.
template <class Change>
void change_heading(Observations& seen, Change changed) {
  change_pose(seen, [&](Pose& pose) {
    pose.heading = core::normalize_angle(changed(pose.heading));
    pose.orientation = quaternion(yaw(pose.heading));
  });
}

}  // namespace

std::vector<Fault> pose_faults() {
  return {
      {"poses_are_usable",
       "NoPosition",
       [](Observations& seen) { change_pose(seen, [](Pose& pose) { pose.position.x = kNaN; }); },
       "100 of 100 poses can't be used; the last of them: localization: pose.position.x is nan",
       "publish finite numbers",
       {}},
      {"heading_is_filled",
       "HeadingNeverFilled",
       [](Observations& seen) { change_pose(seen, [](Pose& pose) { pose.heading = 0.0; }); },
       "pose.heading is 0 all the time while the vehicle moves towards",
       "set it to NaN",
       {}},
      {"heading_is_filled",
       "HeadingNeverFilledStanding",
       [](Observations& seen) {
         stop(seen);
         change_pose(seen, [](Pose& pose) {
           pose.heading = 0.0;
           pose.orientation = quaternion(yaw(2.5));
         });
       },
       "pose.heading is 0 all the time while pose.orientation says 143 degrees",
       "set it to NaN",
       {}},
      {"heading_is_in_radians",
       "HeadingInDegrees",
       [](Observations& seen) { change_pose(seen, [](Pose& pose) { pose.heading *= 180.0 / kPi; }); },
       "which is no angle in radians",
       "not in degrees",
       {}},
      {"orientation_fits_heading",
       "OrientationIsRfu",
       [](Observations& seen) { turn_orientation(seen, -kPi / 2.0); },
       "differ by a constant 90 degrees: the orientation is that of an RFU",
       "/relative_map/orientation_convention to rfu",
       {}},
      {"orientation_fits_heading",
       "OrientationIsFluButRfuIsSet",
       [](Observations& seen) { seen.config.orientation_convention = OrientationConvention::kRfu; },
       "differ by a constant -90 degrees: the orientation is that of an FLU",
       "/relative_map/orientation_convention to flu",
       {}},
      {"orientation_fits_heading",
       "OrientationTurnedByMounting",
       [](Observations& seen) { turn_orientation(seen, 0.7); },
       "differ by a constant -40 degrees",
       "set pose.heading to NaN",
       {"poses_are_usable"}},
      {"heading_fits_motion",
       "SensorMountedBackwards",
       [](Observations& seen) { change_heading(seen, [](double heading) { return heading + kPi; }); },
       "backwards, while the gear is not REVERSE",
       "180 degrees",
       {"a_line_runs_along"}},
      {"heading_fits_motion",
       "ForwardInReverseGear",
       [](Observations& seen) {
         change(seen.chassis, [](Chassis& chassis) { chassis.gear_location = Chassis::GEAR_REVERSE; });
       },
       "backwards, while the gear is REVERSE",
       "fill gear_location in /chassis",
       {}},
      {"heading_fits_motion",
       "CompassHeading",
       [](Observations& seen) { change_heading(seen, [](double heading) { return kPi / 2.0 - heading; }); },
       "this is a compass heading, clockwise from north",
       "pi/2 - that angle",
       {"yaw_rate_fits_motion", "a_line_runs_along"}},
  };
}

std::vector<Fault> motion_faults() {
  return {
      {"velocity_fits_motion",
       "VelocityInTheBodyFrame",
       [](Observations& seen) {
         change_pose(seen, [](Pose& pose) {
           pose.linear_velocity.x = 10.0;
           pose.linear_velocity.y = 0.1;
         });
       },
       "it seems to be in the body frame",
       "in the map frame",
       {}},
      {"yaw_rate_fits_motion",
       "YawRateInDegrees",
       [](Observations& seen) {
         change_pose(seen, [](Pose& pose) { pose.angular_velocity_vrf.z *= 180.0 / kPi; });
       },
       "pose.angular_velocity_vrf.z adds up to",
       "it seems to be in degrees",
       {}},
      {"yaw_rate_fits_motion",
       "YawRateNeverFilled",
       [](Observations& seen) { change_pose(seen, [](Pose& pose) { pose.angular_velocity_vrf.z = 0.0; }); },
       "adds up to 0 degrees",
       "fill pose.angular_velocity_vrf",
       {}},
      {"speeds_agree",
       "ChassisInKilometersPerHour",
       [](Observations& seen) { set_speed(seen, 36.0); },
       "36.0 m/s by /chassis's speed_mps, 10.0 m/s by /localization's positions",
       "km/h",
       {}},
      {"speeds_agree",
       "ChassisNeverFilled",
       [](Observations& seen) { set_speed(seen, 0.0); },
       "0.0 m/s by /chassis's speed_mps",
       "never to be filled",
       {}},
      {"speeds_agree",
       "VelocityInKilometersPerHour",
       [](Observations& seen) {
         change_pose(seen, [](Pose& pose) {
           pose.linear_velocity.x *= 3.6;
           pose.linear_velocity.y *= 3.6;
         });
       },
       "36.0 m/s by /localization's linear_velocity",
       "km/h",
       {}},
  };
}

std::vector<Fault> line_faults() {
  return {
      {"lines_are_usable",
       "NoLine",
       [](Observations& seen) {
         change(seen.navigation, [](NavigationInfo& info) { info.navigation_path.clear(); });
       },
       "/navigation holds no line",
       "send lines of two or more distinct points",
       {}},
      {"lines_are_usable",
       "LineWithoutPlace",
       [](Observations& seen) { change_each_point(seen, [](PathPoint& point) { point.x = kNaN; }); },
       "/navigation: 0 of 1 lines can be used: line 'bend' is left out",
       "finite x and y",
       {}},
      {"a_line_is_near",
       "OtherUtmZone",
       [](Observations& seen) { change_each_point(seen, [](PathPoint& point) { point.x += 4e5; }); },
       "the nearest line, 'bend', is 399.8 km away",
       "another UTM zone, map origin",
       {}},
      {"a_line_is_near",
       "XAndYSwapped",
       [](Observations& seen) {
         change_each_point(seen, [](PathPoint& point) { std::swap(point.x, point.y); });
       },
       "the line begins at (4425000.0, 448000.0) m",
       "swap x and y",
       {}},
      {"a_line_is_near",
       "OffTheRoute",
       [](Observations& seen) { change_each_point(seen, [](PathPoint& point) { point.x += 50.0; }); },
       "m away",
       "drive to the line",
       {}},
      {"a_line_runs_along",
       "OpposedLine",
       [](Observations& seen) {
         change_points(seen,
                       [](std::vector<PathPoint>& points) { std::reverse(points.begin(), points.end()); });
       },
       "all lines in reach are opposed to the vehicle",
       "turn the vehicle round",
       {}},
  };
}

std::vector<Fault> marker_faults() {
  return {
      {"markers_are_not_mirrored",
       "YPositiveToTheRight",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) {
           markers.left_lane_marker.c0_position *= -1.0;
           markers.right_lane_marker.c0_position *= -1.0;
         });
       },
       "c0_position -1.75 m and 1.75 m",
       "turn the signs",
       {}},
      {"markers_make_a_lane",
       "ViewRangeNeverFilled",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) {
           markers.left_lane_marker.view_range = markers.right_lane_marker.view_range = 0.0;
         });
       },
       "of 50 messages 50 make no lane",
       "fill view_range",
       {}},
      {"marker_quality_is_a_share",
       "QualityFromZeroToThree",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) {
           markers.left_lane_marker.quality = 3.0;
           markers.right_lane_marker.quality = 2.0;
         });
       },
       "quality is up to 3.00, but must lie from 0 to 1",
       "divide it by the greatest value",
       {}},
      {"marker_curvature_is_halved",
       "CurvatureNotHalved",
       [](Observations& seen) {
         change(seen.lane_markers, [](LaneMarkers& markers) {
           markers.left_lane_marker.c2_curvature = markers.right_lane_marker.c2_curvature = 0.01;
         });
       },
       "c2_curvature is 1.0 times the curvature of the vehicle's way",
       "half the curvature",
       {}},
  };
}

std::vector<Fault> map_faults() {
  return {
      {"maps_have_lanes",
       "EmptyMaps",
       [](Observations& seen) {
         seen.maps[3].status = {core::StatusCode::kStaleLocalization, "the newest localization is 2 s old"};
       },
       "1 of 50 maps are empty with STALE_LOCALIZATION: the newest localization is 2 s old",
       "rate and stamps",
       {}},
      {"maps_keep_the_contract",
       "BadMap",
       [](Observations& seen) {
         seen.maps[3].violations = {{"finite", "s is nan"}};
       },
       "1 of 50 maps break the output contract, for instance finite: s is nan",
       "do not drive by it",
       {}},
      {"maps_come_often_enough",
       "SlowMaps",
       [](Observations& seen) { thin_out(seen.maps, 3); },
       "but rate is 10.0 Hz",
       "tick time",
       {}},
  };
}

}  // namespace relative_map::doctor::test
