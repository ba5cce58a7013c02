#include "relative_map/pipeline/relative_map_pipeline.hpp"

#include <algorithm>
#include <utility>

#include "relative_map/model/remarks.hpp"
#include "relative_map/pipeline/lanes/lane_width.hpp"
#include "relative_map/pipeline/lanes/map_builder.hpp"
#include "relative_map/pipeline/lanes/narrow_lanes.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kMostNoted = 20;  // remarks between two ticks
constexpr double kBeforeFold = 5.0;     // [m] that a lane ends before a place without borders

/// [m] of a side at the first sample that is beside or ahead of the vehicle.
double width_beside(const std::vector<WidthSample>& samples, double s_at_vehicle) {
  const auto after = std::find_if(samples.begin(), samples.end(),
                                  [&](const WidthSample& sample) { return sample.s >= s_at_vehicle; });
  return after == samples.end() ? samples.back().width : after->width;
}

}  // namespace

bool RelativeMapPipeline::set_localization(const Localization& link,
                                           const std::optional<Eigen::Isometry3d>& link_from_base,
                                           std::optional<Time> received) {
  const MotionInputs::News news = motion_.take(link, link_from_base, config_->max_age, received);
  if (news.time_went_back) forget_what_was_seen();
  note(news.remarks);
  for (MapMethod* method : {static_cast<MapMethod*>(&estimated_), static_cast<MapMethod*>(&fixed_weight_)}) {
    if (news.odometry_failed) method->doubt_motion();
    if (news.moved) method->move(motion_.poses().newest(), *config_);
  }
  return !news.dropped;
}

void RelativeMapPipeline::set_lane_markers(const LaneMarkers& given, std::optional<Time> received) {
  const StampOrder::Verdict order = marker_order_.judge(given.stamp, received, config_->max_age.lane_markers);
  if (!order.remark.empty()) note({order.remark});
  if (!order.take) return;
  const Checked<LaneMarkers> markers = check_lane_markers(given);
  note(markers.remarks);
  markers_ = NewestMarkers{markers.input.stamp, markers.remarks};
  estimated_.see(markers.input);
  fixed_weight_.see(markers.input);
}

void RelativeMapPipeline::set_chassis(const Chassis& chassis, std::optional<Time> received) {
  note(motion_.take(chassis, config_->max_age, received));
}

void RelativeMapPipeline::reset() {
  motion_.reset();
  forget_what_was_seen();
}

bool RelativeMapPipeline::set_clock(Time now) {
  const bool went_back = last_tick_ && goes_back(*last_tick_, now);
  if (went_back) {
    reset();
    last_stamp_ = Time();
  }
  last_tick_ = now;
  return went_back;
}

void RelativeMapPipeline::forget_what_was_seen() {
  marker_order_.reset();
  markers_.reset();
  estimated_.reset();
  fixed_weight_.reset();
  lines_.reset();
  current_id_.clear();
  noted_.clear();
}

void RelativeMapPipeline::note(const std::vector<std::string>& remarks) {
  add_new(noted_, remarks);
  noted_.resize(std::min(noted_.size(), kMostNoted));
}

RelativeMap RelativeMapPipeline::tick(Time now) {
  set_clock(now);
  remarks_ = std::exchange(noted_, {});
  std::variant<RelativeMap, Status> built = build(now);
  if (auto* status = std::get_if<Status>(&built)) {
    // Without a pose that holds, the statement is about now.
    const bool has_pose =
        status->code != StatusCode::kNoLocalization && status->code != StatusCode::kStaleLocalization;
    return empty_map(std::move(*status), has_pose ? *motion_.stamp() : now);
  }
  RelativeMap& map = std::get<RelativeMap>(built);
  map.sequence_num = ++sequence_num_;
  last_stamp_ = map.stamp;
  return std::move(map);
}

RelativeMap RelativeMapPipeline::empty_map(Status status, Time stamp) {
  RelativeMap map;
  map.stamp = last_stamp_ = std::max(stamp, last_stamp_);
  map.frame_id = config_->base_frame;
  map.status = std::move(status);
  map.sequence_num = ++sequence_num_;
  return map;
}

std::variant<RelativeMap, Status> RelativeMapPipeline::build(Time now) {
  const auto localized = motion_.vehicle(now, config_->max_age, remarks_);
  if (const auto* status = std::get_if<Status>(&localized)) return *status;
  if (markers_ && to_seconds(now - markers_->stamp) <= config_->max_age.lane_markers)
    add_new(remarks_, markers_->remarks);

  auto found = method().find_lanes({now, last_stamp_, std::get<VehicleState>(localized), motion_, *config_,
                                    lines_, current_id_, remarks_});
  if (auto* nothing = std::get_if<Status>(&found)) {
    for (const std::string& remark : remarks_) nothing->message += "; " + remark;
    if (!markers_) nothing->message += "; lane markers: none received yet";
    return std::move(*nothing);
  }
  return map_of(std::get<FoundLanes>(std::move(found)));
}

MapMethod& RelativeMapPipeline::method() {
  // Weight 0 is the line alone, whatever the method.
  const NavigationLaneParam& lane = config_->navigation_lane;
  const bool estimated = config_->lane_fusion.method == "estimator" &&
                         (lane.lane_marker_weight > 0.0 || lane.lane_source == LaneSource::kPerception);
  if (estimated) return estimated_;
  return fixed_weight_;
}

/// Without a lane that winds or folds so tightly that it can't have borders; false: then the vehicle's own
/// lane would be too short.
bool RelativeMapPipeline::leave_out(const BadLane& bad, FoundLanes& found) {
  LanePath& lane = found.lanes[bad.lane];
  const bool cut = cut_short(lane, bad.s - kBeforeFold);
  if (!cut && bad.lane == found.current) return false;
  add_new(remarks_, {"line '" + lane.id + (cut ? "' is cut short: " : "' is left out: ") + bad.what});
  if (cut) return true;
  found.lanes.erase(found.lanes.begin() + static_cast<std::ptrdiff_t>(bad.lane));
  if (bad.lane < found.current) --found.current;
  return true;
}

std::variant<RelativeMap, Status> RelativeMapPipeline::map_of(FoundLanes found) {
  const double s_at_vehicle = found.lanes[found.current].s_at_vehicle;
  const MapContext context = MapContext::of(*config_);
  const auto build_lanes = [&] {
    LaneBorders borders = find_borders(found.lanes, config_->navigation_lane.max_lane_half_width);
    return build_map(found.lanes, std::move(borders), found.current, found.paint, *config_);
  };
  RelativeMap map = build_lanes();
  while (const std::optional<BadLane> bad = find_bad_lane(map, context)) {
    take_back(std::move(map), found.lanes);
    if (!leave_out(*bad, found))
      return Status{StatusCode::kLineEnd, "no lane has such borders: " + bad->what};
    map = build_lanes();
  }
  map.stamp = found.vehicle.stamp;
  map.fusion = std::move(found.fusion);
  const Lane& lane = map.lanes[found.current];
  map.fusion.left_half_width.value = width_beside(lane.left_samples, s_at_vehicle);
  map.fusion.right_half_width.value = width_beside(lane.right_samples, s_at_vehicle);
  current_id_ = map.current_lane_id;
  return map;
}

}  // namespace relative_map::core
