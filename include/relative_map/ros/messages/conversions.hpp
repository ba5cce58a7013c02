#pragma once

#include <relative_map/Chassis.h>
#include <relative_map/LaneMarkers.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/MapMsg.h>
#include <relative_map/NavigationInfo.h>
#include <ros/time.h>

#include <string>

#include "relative_map/model/inputs.hpp"
#include "relative_map/model/map.hpp"

namespace relative_map {

/// What `pose.orientation` turns into the map frame: FLU (x forward) or Apollo's RFU (y forward).
enum class OrientationConvention { kFlu, kRfu };

core::Time to_core(const ros::Time& time);
ros::Time to_ros(core::Time time);

core::NavigationInfo to_core(const NavigationInfo& message);
/// The speed's sign from the gear. A zero stamp reads as `received`, here and below: it was not filled.
core::Chassis to_core(const Chassis& message, const ros::Time& received);
/// Of the link that the message is about; RFU orientation and rates are turned to FLU.
core::Localization to_core(const LocalizationEstimate& message, OrientationConvention convention,
                           const ros::Time& received);
core::LaneMarkers to_core(const LaneMarkers& message, const core::Pose2& base_from_sensor,
                          const ros::Time& received);

/// Everything but `lane_marker` and `localization`, which are as received.
MapMsgPtr to_message(const core::RelativeMap& map);
NavigationInfo to_message(const core::NavigationInfo& info);

/// A map read back, for checking; throws nothing and keeps what does not fit as it is.
core::RelativeMap to_core(const MapMsg& message);

/// Frame names without tf1's leading slash.
std::string frame_name(const std::string& frame_id);

}  // namespace relative_map
