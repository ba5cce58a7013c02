#include "relative_map/pipeline/estimation/estimator_method.hpp"

#include <algorithm>

#include "relative_map/model/remarks.hpp"
#include "relative_map/pipeline/lanes/marker_path.hpp"
#include "relative_map/pipeline/lanes/narrow_lanes.hpp"
#include "relative_map/pipeline/lanes/navigation_line_window.hpp"

namespace relative_map::core {

void EstimatorMethod::move(const VehicleState& localized, const PipelineConfig& config) {
  images_.move(localized);
  estimator_.move(localized, config.lane_fusion);
  marker_estimator_.move(localized);
}

void EstimatorMethod::see(const LaneMarkers& markers) {
  images_.add(markers);
  last_image_ = markers.stamp;
}

void EstimatorMethod::doubt_motion() {
  images_.clear();
  estimator_.doubt_motion();
  marker_estimator_.reset();
}

std::variant<FoundLanes, Status> EstimatorMethod::find_lanes(const Tick& tick) {
  const std::vector<ImageQueue::Image> images =
      images_.take(tick.now, tick.localized.stamp, tick.config, tick.remarks);
  if (last_image_ && to_seconds(tick.now - *last_image_) > tick.config.max_age.lane_markers) {
    tick.remarks.push_back("lane markers: they are " + seconds_text(tick.now - *last_image_) + " old");
  }
  auto lines = tick.lines_in_reach(tick.at_map_time(estimator_.vehicle(tick.localized)));
  if (auto* none = std::get_if<Status>(&lines)) return lane_of_markers(images, std::move(*none), tick);
  marker_estimator_.reset();
  return lanes_of_lines(std::get<TrackedLines>(std::move(lines)), images, tick);
}

FoundLanes EstimatorMethod::lanes_of_lines(TrackedLines lines, const std::vector<ImageQueue::Image>& images,
                                           const Tick& tick) {
  LaneEstimate estimate = estimator_.update(images, lines, tick);
  for (const std::string& remark : estimate.remarks) tick.remarks.push_back("lane markers: " + remark);
  if (!images.empty()) tick.lines.follow(lines, estimate.vehicle, tick.config);  // they have moved it

  FoundLanes found;
  found.vehicle = estimate.vehicle;
  found.fusion.source = Source::kNavigationLine;
  found.lanes = cut_windows(lines, found.vehicle, tick.config);
  found.current = lines.current;
  const double vehicle_half_width = tick.config.footprint.half_width;
  const bool moved =
      estimator_.move_lane(lines.current_line(), vehicle_half_width, found.lanes[found.current]);
  add_new(tick.remarks, make_room(found.lanes, found.current, vehicle_half_width));
  if (!moved) return found;
  estimator_.widen_beside(found.lanes, found.current);
  found.fusion = std::move(estimate.fusion);
  found.paint = estimate.paint;
  found.paint.from += found.lanes[found.current].s_at_vehicle;
  found.paint.to += found.lanes[found.current].s_at_vehicle;
  return found;
}

std::variant<FoundLanes, Status> EstimatorMethod::lane_of_markers(
    const std::vector<ImageQueue::Image>& images, Status otherwise, const Tick& tick) {
  const NavigationLaneParam& param = tick.config.navigation_lane;
  std::vector<std::string> ignored;  // of the newest image
  for (const ImageQueue::Image& image : images) {
    ignored =
        marker_estimator_.see(image.sides, tick.config.map_param.default_half_width(), param, image.stamp);
  }
  for (const std::string& side : ignored) tick.remarks.push_back("lane markers: " + side);
  const auto last_paint = marker_estimator_.last_paint();
  const double age = last_paint ? to_seconds(tick.localized.stamp - *last_paint) : 0.0;
  if (!last_paint || age > tick.config.lane_fusion.hold_time) {
    marker_estimator_.reset();
    return otherwise;
  }
  FoundLanes found;
  FusionState& fusion = found.fusion;
  fusion.source = Source::kLaneMarkers;
  fusion.method = "estimator";
  fusion.left_half_width = marker_estimator_.left_half_width();
  fusion.right_half_width = marker_estimator_.right_half_width();
  fusion.marker_range = std::max(0.0, marker_estimator_.seen_to());
  fusion.marker_age = std::max(0.0, age);
  found.vehicle = tick.at_map_time(tick.localized);
  const double narrowest = tick.config.footprint.half_width;
  const Guide guide{marker_estimator_.centerline(),
                    0.0,
                    0.0,
                    marker_estimator_.seen_to(),
                    std::max(narrowest, fusion.left_half_width.value),
                    std::max(narrowest, fusion.right_half_width.value)};
  const Pose2 base_from_frame = found.vehicle.map_from_base.to_local(tick.localized.map_from_base);
  MarkerPath markers = follow(guide, base_from_frame, found.vehicle.speed, param);
  if (!find_kinks(markers.path.points).empty()) {
    tick.remarks.push_back("lane markers: no vehicle could follow them");
    marker_estimator_.reset();
    return otherwise;
  }
  found.paint = {marker_estimator_.left_paint(), marker_estimator_.right_paint(),
                 BoundaryType::kUnknown,         BoundaryType::kUnknown,
                 markers.trusted_from,           markers.trusted_to};
  found.lanes.push_back(std::move(markers.path));
  return found;
}

}  // namespace relative_map::core
