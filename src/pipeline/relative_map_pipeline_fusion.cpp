// How RelativeMapPipeline gets from lines and paint to lanes: by the estimator, or by a fixed weight.

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/fixed_weight/lane_fusion.hpp"
#include "relative_map/pipeline/lines/current_lane.hpp"
#include "relative_map/pipeline/relative_map_pipeline.hpp"

namespace relative_map::core {

std::variant<RelativeMap, Status> RelativeMapPipeline::build_estimated(const VehicleState& localized,
                                                                       Time now) {
  const std::vector<ImageQueue::Image> images = images_.take(now, localized.stamp, *config_, remarks_);
  if (markers_ && to_seconds(now - markers_->stamp) > config_->max_age.lane_markers) {
    remarks_.push_back("lane markers: they are " + seconds_text(now - markers_->stamp) + " old");
  }
  VehicleState vehicle = predicted(estimator_.corrected(localized), now);
  auto found = lines_in_reach(vehicle);
  if (const auto* status = std::get_if<Status>(&found)) {
    return lane_of_markers(images, localized, now, *status);
  }
  marker_estimator_.reset();
  auto& lines = std::get<std::vector<TrackedLine>>(found);

  const TrackedLine line = choose_current(lines, current_id_);
  estimator_.expect_half_width(
      expected_half_width(lines, line, config_->navigation_lane, default_half_width()));
  estimator_.follow_line(*line.line, line.projection);
  std::vector<std::string> ignored;  // of the newest image
  for (const ImageQueue::Image& image : images) {
    ignored = estimator_.see(image.sides, *line.line, line.projection, image.stamp);
  }
  for (const std::string& side : ignored) remarks_.push_back("lane markers: " + side);
  if (!estimator_.given_up().empty()) remarks_.push_back("lane markers: " + estimator_.given_up());
  if (!images.empty()) {
    vehicle = predicted(estimator_.corrected(localized), now);
    std::vector<std::string> known;  // remarks, from before the images
    auto found_again = lanes_in_reach_.track(vehicle, *config_, known);
    if (auto* again = std::get_if<std::vector<TrackedLine>>(&found_again)) lines = std::move(*again);
  }
  std::vector<LanePath> lanes = cut_lanes(lines, vehicle);
  std::size_t current = choose_current(lanes, current_id_);
  const TrackedLine& current_line =
      *std::find_if(lines.begin(), lines.end(),
                    [&](const TrackedLine& tracked) { return tracked.line->id == lanes[current].id; });
  if (estimator_.apply(*current_line.line, current_line.projection, config_->footprint.half_width,
                       lanes[current])) {
    keep_room_beside(lanes, current);
    estimator_.apply_beside(lanes, current);
  }

  FusionState fusion = estimator_.state(line.projection, vehicle.map_from_base.heading());
  fusion.source = Source::kNavigationLine;
  SeenPaint paint;
  const auto last_paint = estimator_.last_paint();
  if (last_paint && to_seconds(now - *last_paint) <= config_->max_age.lane_markers) {
    const double s = lanes[current].s_at_vehicle;
    fusion.source = Source::kFused;
    fusion.marker_range = estimator_.paint_range();
    fusion.marker_age = std::max(0.0, to_seconds(vehicle.stamp - *last_paint));
    paint = {estimator_.left_paint(),
             estimator_.right_paint(),
             estimator_.next_left_paint(),
             estimator_.next_right_paint(),
             s,
             s + estimator_.paint_range()};
  }
  return finish(std::move(lanes), current, paint, std::move(fusion), vehicle);
}

std::variant<RelativeMap, Status> RelativeMapPipeline::lane_of_markers(
    const std::vector<ImageQueue::Image>& images, const VehicleState& localized, Time now, Status otherwise) {
  std::vector<std::string> ignored;  // of the newest image
  for (const ImageQueue::Image& image : images) {
    ignored = marker_estimator_.see(image.sides, default_half_width(), config_->navigation_lane, image.stamp);
  }
  for (const std::string& side : ignored) remarks_.push_back("lane markers: " + side);
  const auto last_paint = marker_estimator_.last_paint();
  const double age = last_paint ? to_seconds(localized.stamp - *last_paint) : 0.0;
  if (!last_paint || age > config_->lane_fusion.hold_time) {
    marker_estimator_.reset();
    return nothing(std::move(otherwise));
  }
  FusionState fusion;
  fusion.source = Source::kLaneMarkers;
  fusion.method = "estimator";
  fusion.left_half_width = marker_estimator_.left_half_width();
  fusion.right_half_width = marker_estimator_.right_half_width();
  fusion.marker_range = std::max(0.0, marker_estimator_.seen_to());
  fusion.marker_age = std::max(0.0, age);
  const VehicleState vehicle = predicted(localized, now);
  MarkerPath markers = make_marker_path(
      marker_estimator_.centerline(), vehicle.map_from_base.to_local(localized.map_from_base),
      marker_estimator_.seen_to(), std::max(config_->footprint.half_width, fusion.left_half_width.value),
      std::max(config_->footprint.half_width, fusion.right_half_width.value), vehicle.speed,
      config_->navigation_lane);
  if (!find_kinks(markers.path.points).empty()) {
    remarks_.push_back("lane markers: no vehicle could follow them");
    marker_estimator_.reset();
    return nothing(std::move(otherwise));
  }
  const SeenPaint paint{marker_estimator_.left_paint(), marker_estimator_.right_paint(),
                        BoundaryType::kUnknown,         BoundaryType::kUnknown,
                        markers.trusted_from,           markers.trusted_to};
  return finish({std::move(markers.path)}, 0, paint, std::move(fusion), vehicle);
}

std::variant<RelativeMap, Status> RelativeMapPipeline::build_with_fixed_weight(const VehicleState& vehicle,
                                                                               Time now) {
  std::optional<MarkerPath> markers = marker_path(vehicle, now);
  const auto paint_beside = [&](const LanePath& lane) {
    if (!markers) return SeenPaint();
    const double s_from_markers = lane.s_at_vehicle - markers->path.s_at_vehicle;
    return SeenPaint{markers->left_paint.value_or(BoundaryType::kUnknown),
                     markers->right_paint.value_or(BoundaryType::kUnknown),
                     BoundaryType::kUnknown,
                     BoundaryType::kUnknown,
                     markers->trusted_from + s_from_markers,
                     markers->trusted_to + s_from_markers};
  };
  const auto marker_age = [&] { return std::max(0.0, to_seconds(vehicle.stamp - markers_->stamp)); };

  auto found = lines_in_reach(vehicle);
  if (const auto* lines = std::get_if<std::vector<TrackedLine>>(&found)) {
    std::vector<LanePath> lanes = cut_lanes(*lines, vehicle);
    std::size_t current = choose_current(lanes, current_id_);
    FusionState fusion;
    fusion.source = Source::kNavigationLine;
    if (markers) {
      if (const auto why = trust_within_lane(lanes[current], *markers)) {
        remarks_.push_back("lane markers: " + *why);
        markers.reset();
      } else if (auto fused = fuse(*markers, lanes[current])) {
        fusion = std::move(*fused);
        fusion.marker_age = marker_age();
        keep_room_beside(lanes, current);
      } else {
        markers.reset();
      }
    }
    const SeenPaint paint = paint_beside(lanes[current]);
    return finish(std::move(lanes), current, paint, std::move(fusion), vehicle);
  }
  if (!markers) return nothing(std::get<Status>(std::move(found)));
  FusionState fusion;
  fusion.source = Source::kLaneMarkers;
  fusion.marker_range = std::max(0.0, markers->trusted_to - markers->path.s_at_vehicle);
  fusion.marker_age = marker_age();
  const SeenPaint paint = paint_beside(markers->path);
  return finish({markers->path}, 0, paint, std::move(fusion), vehicle);
}

std::optional<MarkerPath> RelativeMapPipeline::marker_path(const VehicleState& vehicle, Time now) {
  const auto unusable = [&](const std::string& why) {
    remarks_.push_back("lane markers: " + why);
    return std::nullopt;
  };
  if (!markers_) return std::nullopt;  // a vehicle without a lane camera is no fault
  const Time age = now - markers_->stamp;
  if (to_seconds(age) > config_->max_age.lane_markers)
    return unusable("they are " + seconds_text(age) + " old");
  const std::optional<Pose2> seen_from = poses_.at(markers_->stamp);
  if (!seen_from) return unusable("no pose is known for their stamp");
  const Pose2 base_from_sensor =
      vehicle.map_from_base.to_local(*seen_from).to_parent(markers_->base_from_sensor);
  auto made = make_marker_path(*markers_, base_from_sensor, vehicle.speed, config_->map_param,
                               config_->navigation_lane);
  if (const auto* why = std::get_if<std::string>(&made)) return unusable(*why);
  if (!find_kinks(std::get<MarkerPath>(made).path.points).empty())
    return unusable("no vehicle could follow them");
  return std::get<MarkerPath>(std::move(made));
}

std::optional<FusionState> RelativeMapPipeline::fuse(const MarkerPath& markers, LanePath& lane) {
  const LanePath line = lane;
  FusionState fusion = fuse_fixed_weight(markers, config_->navigation_lane.lane_marker_weight,
                                         config_->lane_fusion.fade_length, lane);
  if (find_kinks(lane.points).empty()) return fusion;
  remarks_.push_back("lane markers: no vehicle could follow line '" + line.id + "' where they move it");
  lane = line;
  return std::nullopt;
}

}  // namespace relative_map::core
