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

std::string seconds_text(Time duration) {
  std::ostringstream text;
  text.precision(3);
  text << to_seconds(duration) << " s";
  return text.str();
}

}  // namespace

bool RelativeMapPipeline::set_localization(const Localization& link,
                                           const std::optional<Eigen::Isometry3d>& link_from_base) {
  if (localization_ && link.stamp < localization_->input.stamp) {
    if (localization_->input.stamp - link.stamp < kLate) return false;
    reset();
  }
  localization_ = check_localization(link);
  if (localization_->refusal) return true;
  if (link_from_base) localization_->input = carry_to_base(localization_->input, *link_from_base);
  const auto state = make_vehicle_state(localization_->input, fresh_chassis(link.stamp));
  if (const auto* vehicle = std::get_if<VehicleState>(&state)) poses_.add(*vehicle);
  return true;
}

void RelativeMapPipeline::set_lane_markers(const LaneMarkers& markers) {
  Checked<LaneMarkers> checked = check_lane_markers(markers);
  marker_remarks_ = std::move(checked.remarks);
  markers_ = std::move(checked.input);
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
  marker_remarks_.clear();
  poses_.clear();
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
  std::optional<MarkerPath> markers = marker_path(vehicle, now);

  Status no_lines{StatusCode::kMarkersUnusable,
                  "lane_source is PERCEPTION, and the lane markers are unusable"};
  if (config_->navigation_lane.lane_source == LaneSource::kOfflineGenerated) {
    auto found = lanes_in_reach_.find(vehicle, *config_, remarks_);
    if (auto* lanes = std::get_if<std::vector<LanePath>>(&found)) {
      std::size_t current = choose_current(*lanes);
      FusionState fusion;
      fusion.source = Source::kNavigationLine;
      if (markers) {
        if (const auto why = trust_within_lane((*lanes)[current], *markers)) {
          remarks_.push_back("lane markers: " + *why);
          markers.reset();
        } else {
          if (auto fused = fuse(*markers, *lanes, current)) {
            fusion = std::move(*fused);
          } else {
            markers.reset();
          }
        }
      }
      return finish(std::move(*lanes), current, markers, std::move(fusion), vehicle);
    }
    no_lines = std::get<Status>(found);
  }
  if (!markers) {
    if (!markers_) remarks_.push_back("lane markers: none received yet");
    for (const std::string& remark : remarks_) no_lines.message += "; " + remark;
    return no_lines;
  }
  FusionState fusion;
  fusion.source = Source::kLaneMarkers;
  fusion.marker_range = std::max(0.0, markers->trusted_to - markers->path.s_at_vehicle);
  return finish({markers->path}, 0, markers, std::move(fusion), vehicle);
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
  add_remarks(marker_remarks_);
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
  if (!find_kinks(std::get<MarkerPath>(made).path.points).empty())
    return unusable("no vehicle could follow them");
  return std::get<MarkerPath>(std::move(made));
}

std::size_t RelativeMapPipeline::choose_current(const std::vector<LanePath>& lanes) const {
  std::size_t current = 0;
  const auto distance = [&](std::size_t i) {
    const double to_start = std::max(0.0, -lanes[i].s_at_vehicle);  // of a lane that begins ahead
    return std::hypot(lanes[i].l, to_start) - (lanes[i].id == current_id_ ? kHysteresis : 0.0);
  };
  for (std::size_t i = 1; i < lanes.size(); ++i) {
    if (distance(i) < distance(current)) current = i;
  }
  return current;
}

std::optional<FusionState> RelativeMapPipeline::fuse(const MarkerPath& markers, std::vector<LanePath>& lanes,
                                                     std::size_t& current) {
  const LanePath line = lanes[current];
  FusionState fusion = fuse_fixed_weight(markers, config_->navigation_lane.lane_marker_weight,
                                         config_->lane_fusion.fade_length, lanes[current]);
  if (!find_kinks(lanes[current].points).empty()) {
    remarks_.push_back("lane markers: no vehicle could follow line '" + line.id + "' where they move it");
    lanes[current] = line;
    return std::nullopt;
  }
  // The lane has moved: others may lie too near to where it is now, which is where the paint says.
  const std::string id = lanes[current].id;
  sort_left_to_right(lanes);
  add_remarks(drop_narrow_lanes(lanes, config_->footprint.half_width, id));
  for (current = 0; lanes[current].id != id;) ++current;
  return fusion;
}

RelativeMap RelativeMapPipeline::finish(std::vector<LanePath> lanes, std::size_t current,
                                        const std::optional<MarkerPath>& markers, FusionState fusion,
                                        const VehicleState& vehicle) {
  SeenPaint paint;
  const double s_at_vehicle = lanes[current].s_at_vehicle;
  if (markers) {
    const double s_from_markers = s_at_vehicle - markers->path.s_at_vehicle;
    paint = {markers->left_paint.value_or(BoundaryType::kUnknown),
             markers->right_paint.value_or(BoundaryType::kUnknown), markers->trusted_from + s_from_markers,
             markers->trusted_to + s_from_markers};
    fusion.marker_age = std::max(0.0, to_seconds(vehicle.stamp - markers_->stamp));
  }
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
