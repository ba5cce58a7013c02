#include "relative_map/pipeline/relative_map_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "relative_map/pipeline/lane_fusion.hpp"

namespace relative_map::core {

namespace {

constexpr Time kLate =
    std::chrono::milliseconds(500);  // an older message than the newest, but of the same time
constexpr double kHysteresis = 0.3;  // [m] by which another lane must be nearer to become the current one

/// [m] from the vehicle to a lane, or to the start of one that begins ahead.
double distance_to(double l, double s, bool is_current) {
  return std::hypot(l, std::max(0.0, -s)) - (is_current ? kHysteresis : 0.0);
}

std::string seconds_text(Time duration) {
  std::ostringstream text;
  text.precision(3);
  text << to_seconds(duration) << " s";
  return text.str();
}

}  // namespace

void RelativeMapPipeline::set_localization(const Localization& link,
                                           const std::optional<Eigen::Isometry3d>& link_from_base) {
  if (localization_ && link.stamp < localization_->input.stamp) {
    if (localization_->input.stamp - link.stamp < kLate) return;
    reset();
  }
  localization_ = check_localization(link);
  if (localization_->refusal) return;
  if (link_from_base) localization_->input = carry_to_base(localization_->input, *link_from_base);
  const auto state = make_vehicle_state(localization_->input, fresh_chassis(link.stamp));
  const auto* vehicle = std::get_if<VehicleState>(&state);
  if (!vehicle) return;
  poses_.add(*vehicle);
  images_.move(poses_.newest());
  estimator_.move(poses_.newest());
  marker_estimator_.move(poses_.newest());
}

void RelativeMapPipeline::set_lane_markers(const LaneMarkers& markers) {
  markers_ = markers;
  images_.add(markers);
}

std::optional<Chassis> RelativeMapPipeline::fresh_chassis(Time now) const {
  if (!chassis_) return std::nullopt;
  const double age = to_seconds(now - chassis_->input.stamp);
  if (std::abs(age) > config_->max_age.chassis) return std::nullopt;
  return chassis_->input;
}

void RelativeMapPipeline::reset() {
  localization_.reset();
  chassis_.reset();
  markers_.reset();
  poses_.clear();
  images_.clear();
  estimator_.reset();
  marker_estimator_.reset();
  current_id_.clear();
  lanes_in_reach_.reset();
}

std::optional<Time> RelativeMapPipeline::pose_stamp() const {
  if (!localization_) return std::nullopt;
  return localization_->input.stamp;
}

RelativeMap RelativeMapPipeline::tick(Time now) {
  remarks_.clear();
  std::variant<RelativeMap, Status> built = build(now);
  if (auto* status = std::get_if<Status>(&built)) {
    // Without a pose that holds, the statement is about now.
    const bool has_pose =
        status->code != StatusCode::kNoLocalization && status->code != StatusCode::kStaleLocalization;
    return empty_map(std::move(*status), has_pose ? localization_->input.stamp : now);
  }
  RelativeMap& map = std::get<RelativeMap>(built);
  map.sequence_num = ++sequence_num_;
  return std::move(map);
}

RelativeMap RelativeMapPipeline::empty_map(Status status, Time stamp) {
  RelativeMap map;
  map.stamp = stamp;
  map.frame_id = config_->base_frame;
  map.status = std::move(status);
  map.sequence_num = ++sequence_num_;
  return map;
}

std::variant<RelativeMap, Status> RelativeMapPipeline::build(Time now) {
  const auto state = vehicle_state(now);
  if (const auto* status = std::get_if<Status>(&state)) return *status;
  const VehicleState& vehicle = std::get<VehicleState>(state);
  return config_->lane_fusion.method == "estimator" ? build_estimated(vehicle, now)
                                                    : build_with_fixed_weight(vehicle, now);
}

std::variant<RelativeMap, Status> RelativeMapPipeline::build_estimated(const VehicleState& localized,
                                                                       Time now) {
  const std::vector<ImageQueue::Image> images = images_.take(now, localized.stamp, *config_, remarks_);
  VehicleState vehicle = estimator_.corrected(localized);
  auto found = lines_in_reach(vehicle);
  if (const auto* status = std::get_if<Status>(&found)) return lane_of_markers(images, localized, *status);
  marker_estimator_.reset();
  auto& lines = std::get<std::vector<TrackedLine>>(found);

  const TrackedLine line = choose_line(lines);
  for (const ImageQueue::Image& image : images) {
    for (const std::string& side : estimator_.see(image.sides, *line.line, line.projection, image.stamp)) {
      remarks_.push_back("lane markers: " + side);
    }
  }
  if (!images.empty()) {
    vehicle = estimator_.corrected(localized);
    std::vector<std::string> known;  // remarks, from before the images
    auto found_again = lanes_in_reach_.track(vehicle, *config_, known);
    if (auto* again = std::get_if<std::vector<TrackedLine>>(&found_again)) lines = std::move(*again);
  }
  std::vector<LanePath> lanes = cut_lanes(lines, vehicle);
  std::size_t current = choose_current(lanes);
  if (estimator_.apply(lanes[current])) keep_room_beside(lanes, current);

  FusionState fusion = estimator_.state(line.projection, vehicle.map_from_base.heading());
  fusion.source = Source::kNavigationLine;
  SeenPaint paint;
  const auto last_paint = estimator_.last_paint();
  if (last_paint && to_seconds(now - *last_paint) <= config_->max_age.lane_markers) {
    const double s = lanes[current].s_at_vehicle;
    fusion.source = Source::kFused;
    fusion.marker_range = estimator_.paint_range();
    fusion.marker_age = std::max(0.0, to_seconds(vehicle.stamp - *last_paint));
    paint = {estimator_.left_paint(), estimator_.right_paint(), s, s + estimator_.paint_range()};
  }
  return finish(std::move(lanes), current, paint, std::move(fusion), vehicle);
}

std::variant<RelativeMap, Status> RelativeMapPipeline::lane_of_markers(
    const std::vector<ImageQueue::Image>& images, const VehicleState& vehicle, Status otherwise) {
  const double default_half_width =
      0.5 * (config_->map_param.default_left_width + config_->map_param.default_right_width);
  for (const ImageQueue::Image& image : images) {
    for (const std::string& side : marker_estimator_.see(image.sides, default_half_width, image.stamp)) {
      remarks_.push_back("lane markers: " + side);
    }
  }
  const auto last_paint = marker_estimator_.last_paint();
  const double age = last_paint ? to_seconds(vehicle.stamp - *last_paint) : 0.0;
  if (!last_paint || age > config_->lane_fusion.hold_time) {
    marker_estimator_.reset();
    return nothing(std::move(otherwise));
  }
  const NavigationLaneParam& param = config_->navigation_lane;
  FusionState fusion;
  fusion.source = Source::kLaneMarkers;
  fusion.method = "estimator";
  fusion.left_half_width = marker_estimator_.left_half_width();
  fusion.right_half_width = marker_estimator_.right_half_width();
  fusion.marker_range = std::max(0.0, marker_estimator_.seen_to());
  fusion.marker_age = std::max(0.0, age);
  MarkerPath markers = make_marker_path(
      marker_estimator_.centerline(), marker_estimator_.seen_to(), fusion.left_half_width.value,
      fusion.right_half_width.value, vehicle.speed, param);
  const SeenPaint paint{marker_estimator_.left_paint(), marker_estimator_.right_paint(), markers.trusted_from,
                        markers.trusted_to};
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
                     markers->trusted_from + s_from_markers, markers->trusted_to + s_from_markers};
  };
  const auto marker_age = [&] { return std::max(0.0, to_seconds(vehicle.stamp - markers_->stamp)); };

  auto found = lines_in_reach(vehicle);
  if (const auto* lines = std::get_if<std::vector<TrackedLine>>(&found)) {
    std::vector<LanePath> lanes = cut_lanes(*lines, vehicle);
    std::size_t current = choose_current(lanes);
    FusionState fusion;
    fusion.source = Source::kNavigationLine;
    if (markers) {
      if (const auto why = trust_within_lane(lanes[current], *markers)) {
        remarks_.push_back("lane markers: " + *why);
        markers.reset();
      } else {
        fusion = fuse_fixed_weight(*markers, config_->navigation_lane.lane_marker_weight,
                                   config_->lane_fusion.fade_length, lanes[current]);
        fusion.marker_age = marker_age();
        keep_room_beside(lanes, current);
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

Status RelativeMapPipeline::nothing(Status status) const {
  for (const std::string& remark : remarks_) status.message += "; " + remark;
  if (!markers_) status.message += "; lane markers: none received yet";
  return status;
}

std::variant<std::vector<TrackedLine>, Status> RelativeMapPipeline::lines_in_reach(
    const VehicleState& vehicle) {
  if (config_->navigation_lane.lane_source == LaneSource::kPerception) {
    return Status{StatusCode::kMarkersUnusable,
                  "lane_source is PERCEPTION, and the lane markers are unusable"};
  }
  return lanes_in_reach_.track(vehicle, *config_, remarks_);
}

std::vector<LanePath> RelativeMapPipeline::cut_lanes(const std::vector<TrackedLine>& lines,
                                                     const VehicleState& vehicle) {
  std::vector<LanePath> lanes = cut_windows(lines, vehicle, *config_);
  add_remarks(drop_narrow_lanes(lanes, config_->footprint.half_width));
  return lanes;
}

std::variant<VehicleState, Status> RelativeMapPipeline::vehicle_state(Time now) {
  if (!localization_) return Status{StatusCode::kNoLocalization, "no localization received yet"};
  const Time age = now - localization_->input.stamp;
  if (to_seconds(age) > config_->max_age.localization) {
    return Status{StatusCode::kStaleLocalization, "the newest localization is " + seconds_text(age) + " old"};
  }
  if (to_seconds(-age) > config_->max_age.localization) {
    return Status{StatusCode::kInvalidLocalization,
                  "localization: header.stamp is " + seconds_text(-age) + " in the future"};
  }
  if (localization_->refusal) return *localization_->refusal;
  add_remarks(localization_->remarks);
  if (chassis_) add_remarks(chassis_->remarks);
  return make_vehicle_state(localization_->input, fresh_chassis(now));
}

void RelativeMapPipeline::add_remarks(const std::vector<std::string>& remarks) {
  remarks_.insert(remarks_.end(), remarks.begin(), remarks.end());
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
  return std::get<MarkerPath>(std::move(made));
}

std::size_t RelativeMapPipeline::choose_current(const std::vector<LanePath>& lanes) const {
  const auto distance = [&](const LanePath& lane) {
    return distance_to(lane.l, lane.s_at_vehicle, lane.id == current_id_);
  };
  const auto nearest =
      std::min_element(lanes.begin(), lanes.end(), [&](const LanePath& a, const LanePath& b) {
        return distance(a) < distance(b);
      });
  return static_cast<std::size_t>(nearest - lanes.begin());
}

const TrackedLine& RelativeMapPipeline::choose_line(const std::vector<TrackedLine>& lines) const {
  const auto distance = [&](const TrackedLine& tracked) {
    return distance_to(tracked.projection.l, tracked.projection.s, tracked.line->id == current_id_);
  };
  return *std::min_element(lines.begin(), lines.end(), [&](const TrackedLine& a, const TrackedLine& b) {
    return distance(a) < distance(b);
  });
}

/// The current lane has moved: others may lie too near to where it is now, which is where the paint says.
void RelativeMapPipeline::keep_room_beside(std::vector<LanePath>& lanes, std::size_t& current) {
  const std::string id = lanes[current].id;
  sort_left_to_right(lanes);
  add_remarks(drop_narrow_lanes(lanes, config_->footprint.half_width, id));
  for (current = 0; lanes[current].id != id;) ++current;
}

RelativeMap RelativeMapPipeline::finish(std::vector<LanePath> lanes, std::size_t current,
                                        const SeenPaint& paint, FusionState fusion,
                                        const VehicleState& vehicle) {
  const double s_at_vehicle = lanes[current].s_at_vehicle;
  LaneBorders borders = find_borders(lanes, config_->navigation_lane.max_lane_half_width);
  RelativeMap map = build_map(std::move(lanes), std::move(borders), current, paint, *config_);
  map.stamp = vehicle.stamp;
  const Lane& lane = map.lanes[current];
  const auto beside_vehicle = [&](const std::vector<WidthSample>& samples) {
    const auto after = std::find_if(samples.begin(), samples.end(),
                                    [&](const WidthSample& sample) { return sample.s >= s_at_vehicle; });
    return after == samples.end() ? samples.back().width : after->width;
  };
  fusion.left_half_width.value = beside_vehicle(lane.left_samples);
  fusion.right_half_width.value = beside_vehicle(lane.right_samples);
  map.fusion = std::move(fusion);
  current_id_ = map.current_lane_id;
  return map;
}

}  // namespace relative_map::core
