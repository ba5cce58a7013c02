#include "relative_map/ros/setup/raw_line.hpp"

#include <algorithm>
#include <cmath>

#include "relative_map/pipeline/lanes/navigation_line_window.hpp"

namespace relative_map {

std::variant<core::VehicleState, core::Status> RawLine::vehicle_of(const MapMsg& map) const {
  core::Localization base = to_core(map.localization, convention_, map.header.stamp);
  const std::string link = frame_name(map.localization.child_frame_id);
  if (!link.empty() && link != map.header.frame_id) {
    const auto link_from_base = transforms_(link, map.header.frame_id, map.localization.header.stamp);
    if (!link_from_base) return core::Status{core::StatusCode::kNoTransform, ""};
    base = core::carry_to_base(base, *link_from_base);
  }
  auto state = core::make_vehicle_state(base, std::nullopt);
  if (auto* vehicle = std::get_if<core::VehicleState>(&state)) {
    if (!std::isfinite(vehicle->yaw_rate)) vehicle->yaw_rate = 0.0;
    const core::Time stamp = to_core(map.header.stamp);  // later than the pose if the map is for its tick
    vehicle->map_from_base = core::carried_on(*vehicle, core::to_seconds(stamp - vehicle->stamp));
    vehicle->stamp = stamp;
  }
  return state;
}

core::Polyline RawLine::beside(const MapMsg& map, const core::NavigationLines* lines, double max_distance) {
  const auto lane = std::find_if(map.hdmap.lane.begin(), map.hdmap.lane.end(),
                                 [&](const Lane& l) { return l.id == map.current_lane_id; });
  if (!lines || lane == map.hdmap.lane.end()) return {};
  const auto line = std::find_if(lines->lines.begin(), lines->lines.end(),
                                 [&](const core::NavigationLine& l) { return l.id == map.current_lane_id; });
  if (line == lines->lines.end()) return {};
  if (lines != lines_ || line->id != id_) tracker_.reset();
  lines_ = lines;
  id_ = line->id;
  const auto state = vehicle_of(map);
  const auto* vehicle = std::get_if<core::VehicleState>(&state);
  if (!vehicle) return {};
  const auto place = tracker_.track(*line, *vehicle, max_distance);
  const auto* projection = std::get_if<core::LineProjection>(&place);
  if (!projection) return {};
  return core::positions_of(cut_window(*line, *projection, vehicle->map_from_base, lane->length).points);
}

}  // namespace relative_map
