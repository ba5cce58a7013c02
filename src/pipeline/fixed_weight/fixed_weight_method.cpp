#include "relative_map/pipeline/fixed_weight/fixed_weight_method.hpp"

#include <algorithm>

#include "relative_map/model/remarks.hpp"
#include "relative_map/pipeline/fixed_weight/lane_fusion.hpp"
#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"
#include "relative_map/pipeline/lanes/narrow_lanes.hpp"
#include "relative_map/pipeline/lanes/navigation_line_window.hpp"

namespace relative_map::core {

namespace {

SeenPaint paint_beside(const LanePath& lane, const MarkerPath& markers) {
  const double s_from_markers = lane.s_at_vehicle - markers.path.s_at_vehicle;
  return {markers.left_paint.value_or(BoundaryType::kUnknown),
          markers.right_paint.value_or(BoundaryType::kUnknown),
          BoundaryType::kUnknown,
          BoundaryType::kUnknown,
          markers.trusted_from + s_from_markers,
          markers.trusted_to + s_from_markers};
}

/// None, and the lane stays as it is: what the markers make of it can't be driven.
std::optional<FusionState> fuse(const MarkerPath& markers, LanePath& lane, const Tick& tick) {
  const LanePath line = lane;
  FusionState fusion = fuse_fixed_weight(markers, tick.config.navigation_lane.lane_marker_weight,
                                         tick.config.lane_fusion.fade_length, lane);
  if (find_kinks(lane.points).empty()) return fusion;
  tick.remarks.push_back("lane markers: no vehicle could follow line '" + line.id + "' where they move it");
  lane = line;
  return std::nullopt;
}

}  // namespace

std::variant<FoundLanes, Status> FixedWeightMethod::find_lanes(const Tick& tick) {
  FoundLanes found;
  found.vehicle = tick.at_map_time(tick.localized);
  std::optional<MarkerPath> markers = marker_path(found.vehicle, tick);
  const auto marker_age = [&] { return std::max(0.0, to_seconds(found.vehicle.stamp - markers_->stamp)); };

  auto lines = tick.lines_in_reach(found.vehicle);
  if (auto* none = std::get_if<Status>(&lines)) {
    if (!markers) return std::move(*none);
    found.fusion.source = Source::kLaneMarkers;
    found.fusion.marker_range = std::max(0.0, markers->trusted_to - markers->path.s_at_vehicle);
    found.fusion.marker_age = marker_age();
    found.paint = paint_beside(markers->path, *markers);
    found.lanes.push_back(std::move(markers->path));
    return found;
  }
  const auto& in_reach = std::get<TrackedLines>(lines);
  found.lanes = cut_windows(in_reach, found.vehicle, tick.config);
  found.current = in_reach.current;
  found.fusion.source = Source::kNavigationLine;
  std::optional<FusionState> fused;
  if (markers) {
    const auto why_not = trust_within_lane(found.lanes[found.current], *markers);
    if (why_not) tick.remarks.push_back("lane markers: " + *why_not);
    if (!why_not) fused = fuse(*markers, found.lanes[found.current], tick);
  }
  add_new(tick.remarks, make_room(found.lanes, found.current, tick.config.footprint.half_width));
  if (fused) {
    found.fusion = std::move(*fused);
    found.fusion.marker_age = marker_age();
    found.paint = paint_beside(found.lanes[found.current], *markers);
  }
  return found;
}

std::optional<MarkerPath> FixedWeightMethod::marker_path(const VehicleState& vehicle,
                                                         const Tick& tick) const {
  const auto unusable = [&](const std::string& why) {
    tick.remarks.push_back("lane markers: " + why);
    return std::nullopt;
  };
  if (!markers_) return std::nullopt;  // a vehicle without a lane camera is no fault
  const auto age = tick.now - markers_->stamp;
  if (to_seconds(age) > tick.config.max_age.lane_markers)
    return unusable("they are " + seconds_text(age) + " old");
  // By odometry: paint stays where it is when localization jumps.
  const std::optional<Pose2> seen_from = tick.motion.dead_reckoning().moved(vehicle.stamp, markers_->stamp);
  if (!seen_from) return unusable("no pose is known for their stamp");
  const Pose2 base_from_sensor = seen_from->to_parent(markers_->base_from_sensor);
  auto made = make_marker_path(*markers_, base_from_sensor, vehicle.speed, tick.config.map_param,
                               tick.config.navigation_lane);
  if (const auto* why = std::get_if<std::string>(&made)) return unusable(*why);
  if (!find_kinks(std::get<MarkerPath>(made).path.points).empty())
    return unusable("no vehicle could follow them");
  return std::get<MarkerPath>(std::move(made));
}

}  // namespace relative_map::core
