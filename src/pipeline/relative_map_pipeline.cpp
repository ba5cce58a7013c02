#include "relative_map/pipeline/relative_map_pipeline.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "relative_map/pipeline/lanes/narrow_lanes.hpp"

namespace relative_map::core {

namespace {

constexpr Time kLate =
    std::chrono::milliseconds(500);     // an older message than the newest, but of the same time
constexpr std::size_t kMostNoted = 20;  // remarks between two ticks

}  // namespace

bool RelativeMapPipeline::set_localization(const Localization& link,
                                           const std::optional<Eigen::Isometry3d>& link_from_base) {
  if (localization_ && link.stamp < localization_->input.stamp) {
    if (localization_->input.stamp - link.stamp < kLate) return false;
    reset();
  }
  localization_ = check_localization(link);
  note(localization_->remarks);
  if (localization_->refusal) {
    note({localization_->refusal->message});
    return true;
  }
  if (link_from_base) localization_->input = carry_to_base(localization_->input, *link_from_base);
  const auto state = make_vehicle_state(localization_->input, fresh_chassis(link.stamp));
  if (const auto* status = std::get_if<Status>(&state)) {
    note({status->message});
    return true;
  }
  const bool trusted = poses_.trusts_odometry();
  poses_.add(std::get<VehicleState>(state));
  if (trusted && !poses_.trusts_odometry()) {
    images_.clear();
    estimator_.doubt_motion();
    marker_estimator_.reset();
  }
  images_.move(poses_.newest());
  estimator_.move(poses_.newest(), config_->lane_fusion);
  marker_estimator_.move(poses_.newest());
  return true;
}

void RelativeMapPipeline::set_lane_markers(const LaneMarkers& markers) {
  Checked<LaneMarkers> checked = check_lane_markers(markers);
  marker_remarks_ = std::move(checked.remarks);
  note(marker_remarks_);
  markers_ = std::move(checked.input);
  images_.add(*markers_);
}

void RelativeMapPipeline::set_chassis(const Chassis& chassis) {
  chassis_ = check_chassis(chassis);
  note(chassis_->remarks);
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
  noted_.clear();
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
  remarks_ = std::exchange(noted_, {});
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
  // Weight 0 is the line alone, whatever the method.
  const NavigationLaneParam& lane = config_->navigation_lane;
  const bool estimated = config_->lane_fusion.method == "estimator" &&
                         (lane.lane_marker_weight > 0.0 || lane.lane_source == LaneSource::kPerception);
  return estimated ? build_estimated(vehicle, now) : build_with_fixed_weight(predicted(vehicle, now), now);
}

VehicleState RelativeMapPipeline::predicted(VehicleState vehicle, Time now) const {
  if (!config_->predict_to_tick) return vehicle;
  if (!poses_.trusts_speed()) vehicle.speed = poses_.newest().speed;
  vehicle.yaw_rate = poses_.newest().yaw_rate;
  vehicle.map_from_base = carried_on(vehicle, to_seconds(now - vehicle.stamp));
  vehicle.stamp = now;
  return vehicle;
}

double RelativeMapPipeline::default_half_width() const {
  return 0.5 * (config_->map_param.default_left_width + config_->map_param.default_right_width);
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
  const std::optional<Chassis> chassis = fresh_chassis(now);
  if (chassis) {
    add_remarks(chassis_->remarks);
    auto disagreement = speeds_disagree(localization_->input, *chassis);
    if (disagreement && poses_.trusts_speed()) add_remarks({std::move(*disagreement)});
  }
  const bool by_chassis = chassis && std::isfinite(chassis->speed);
  add_remarks(poses_.remarks(by_chassis ? "chassis: speed_mps" : "localization: pose.linear_velocity"));
  const bool markers_are_fresh =
      markers_ && to_seconds(now - markers_->stamp) <= config_->max_age.lane_markers;
  if (markers_are_fresh) add_remarks(marker_remarks_);
  auto state = make_vehicle_state(localization_->input, chassis);
  auto* vehicle = std::get_if<VehicleState>(&state);
  if (vehicle && !std::isfinite(vehicle->speed)) vehicle->speed = poses_.newest().speed;
  return state;
}

void RelativeMapPipeline::add_remarks(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) {
    if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) remarks_.push_back(remark);
  }
}

void RelativeMapPipeline::note(const std::vector<std::string>& remarks) {
  for (const std::string& remark : remarks) {
    const bool known = std::find(noted_.begin(), noted_.end(), remark) != noted_.end();
    if (!known && noted_.size() < kMostNoted) noted_.push_back(remark);
  }
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
