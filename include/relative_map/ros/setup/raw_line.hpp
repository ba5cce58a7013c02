#pragma once

#include <relative_map/MapMsg.h>

#include <string>

#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"
#include "relative_map/ros/messages/conversions.hpp"
#include "relative_map/ros/setup/frames.hpp"

namespace relative_map {

/// The line that a map's current lane was made from, as it was recorded: for people to compare the two.
class RawLine {
 public:
  RawLine(OrientationConvention convention, LinkTransforms transforms)
      : convention_(convention), transforms_(std::move(transforms)) {}

  /// In the frame and at the time of the map, along its current lane; empty if there is none. `lines` are
  /// those that the map was made from; they may be none.
  core::Polyline beside(const MapMsg& map, const core::NavigationLines* lines, double max_distance);

 private:
  /// Of the map's frame at the map's time.
  std::variant<core::VehicleState, core::Status> vehicle_of(const MapMsg& map) const;

  OrientationConvention convention_;
  LinkTransforms transforms_;
  const core::NavigationLines* lines_ = nullptr;  ///< to notice others by, not to look into
  std::string id_;
  core::NavigationLineTracker tracker_;
};

}  // namespace relative_map
