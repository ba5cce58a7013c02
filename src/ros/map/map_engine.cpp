#include "relative_map/ros/map/map_engine.hpp"

#include <boost/make_shared.hpp>
#include <cmath>

#include "relative_map/pipeline/contract/map_check.hpp"

namespace relative_map {

namespace {

core::Pose2 planar(const Eigen::Isometry3d& transform) {
  const Eigen::Vector3d forward = transform.rotation() * Eigen::Vector3d::UnitX();
  return {transform.translation().head<2>(), std::atan2(forward.y(), forward.x())};
}

std::string link_of(const std::string& frame_id, const std::string& base_frame) {
  return frame_id.empty() ? base_frame : frame_name(frame_id);
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

/// As received, but for a heading that is not given: it comes from the orientation, since who reads a map
/// reads its localization too, and no number of a map is NaN.
LocalizationEstimateConstPtr with_heading(const LocalizationEstimateConstPtr& message,
                                          const core::Localization& localization) {
  const Eigen::Vector3d forward = localization.map_from_body * Eigen::Vector3d::UnitX();
  if (!std::isnan(message->pose.heading) || !forward.allFinite()) return message;
  const auto filled = boost::make_shared<LocalizationEstimate>(*message);
  filled->pose.heading = std::atan2(forward.y(), forward.x());
  return filled;
}

}  // namespace

MapEngine::MapEngine(const NodeConfig& config, LinkTransforms transforms)
    : config_(std::make_shared<core::PipelineConfig>(config.pipeline)),
      speed_limits_(config.speed_limits),
      convention_(config.orientation_convention),
      transforms_(std::move(transforms)),
      pipeline_(config_) {}

std::shared_ptr<const core::NavigationLines> MapEngine::prepare(const NavigationInfo& message,
                                                                const core::PipelineConfig& config) {
  return core::prepare_navigation_lines(to_core(message), core::IntakeParam::of(config));
}

void MapEngine::set_navigation_lines(std::shared_ptr<const core::NavigationLines> lines) {
  lines_ = lines;
  pipeline_.set_navigation_lines(std::move(lines));
}

void MapEngine::set_config(const core::PipelineConfig& config) {
  config_ = std::make_shared<core::PipelineConfig>(config);
  pipeline_.set_config(config_);
}

void MapEngine::on_localization(const LocalizationEstimateConstPtr& message, const ros::Time& received) {
  const core::Localization localization = to_core(*message, convention_, received);
  const std::string link = link_of(message->child_frame_id, config_->base_frame);
  const std::optional<Eigen::Isometry3d> link_from_base =
      transforms_(link, config_->base_frame, to_ros(localization.stamp));
  if (link_from_base) {
    const bool is_base = link == config_->base_frame;
    // A stray one is dropped: what is passed on with the map must be the pose that the map is for.
    if (!pipeline_.set_localization(localization, is_base ? std::nullopt : link_from_base, to_core(received)))
      return;
  }
  localization_ = with_heading(message, localization);
  newest_pose_ = localization.stamp;
  localization_has_transform_ = link_from_base.has_value();
}

void MapEngine::on_chassis(const ChassisConstPtr& message, const ros::Time& received) {
  pipeline_.set_chassis(to_core(*message, received), to_core(received));
}

void MapEngine::on_lane_markers(const LaneMarkersConstPtr& message, const ros::Time& received) {
  markers_ = message;
  const std::string frame = link_of(message->header.frame_id, config_->base_frame);
  const ros::Time& stamp = message->header.stamp.isZero() ? received : message->header.stamp;
  const std::optional<Eigen::Isometry3d> base_from_sensor = transforms_(config_->base_frame, frame, stamp);
  if (!base_from_sensor) {
    marker_fault_ =
        "lane markers are dropped: no transform from '" + frame + "' to '" + config_->base_frame + "'";
    return;
  }
  marker_fault_.clear();
  pipeline_.set_lane_markers(to_core(*message, planar(*base_from_sensor), received), to_core(received));
}

std::optional<core::Status> MapEngine::localization_fault(const ros::Time& now) const {
  if (!localization_) return std::nullopt;
  if (core::to_seconds(*newest_pose_ - to_core(now)) > config_->max_age.localization) {
    return core::Status{core::StatusCode::kInvalidLocalization,
                        "localization: header.stamp is ahead of the clock"};
  }
  if (!localization_has_transform_) {
    return core::Status{core::StatusCode::kNoTransform, "no transform from localization's child_frame_id '" +
                                                            localization_->child_frame_id + "' to '" +
                                                            config_->base_frame + "'"};
  }
  if (config_->navigation_lane.lane_source == core::LaneSource::kPerception) return std::nullopt;
  const std::string map_frame = frame_name(localization_->header.frame_id);
  if (lines_ && !lines_->lines.empty() && lines_->frame_id != map_frame) {
    return core::Status{core::StatusCode::kFrameMismatch, "navigation is in frame '" + lines_->frame_id +
                                                              "', but localization in '" + map_frame + "'"};
  }
  return std::nullopt;
}

bool MapEngine::pose_is_of_now(const ros::Time& now) const {
  return newest_pose_ &&
         std::abs(core::to_seconds(to_core(now) - *newest_pose_)) <= config_->max_age.localization;
}

/// A lane is named as its line was.
void MapEngine::set_speed_limits(core::RelativeMap& map) const {
  for (core::Lane& lane : map.lanes) {
    const auto limit = speed_limits_.find(lane.name);
    if (limit != speed_limits_.end()) lane.speed_limit = limit->second;
  }
}

MapMsgPtr MapEngine::tick(const ros::Time& now) {
  if (pipeline_.set_clock(to_core(now))) {
    reset();
    map_ = core::RelativeMap();
  }
  const bool of_now = pose_is_of_now(now);
  if (of_now && mapped_pose_ == newest_pose_ && !config_->predict_to_tick) return nullptr;
  mapped_pose_ = newest_pose_;

  const std::optional<core::Status> fault = localization_fault(now);
  core::RelativeMap built = fault ? pipeline_.empty_map(*fault, of_now ? *newest_pose_ : to_core(now))
                                  : pipeline_.tick(to_core(now));
  set_speed_limits(built);
  core::MapContext context = core::MapContext::of(*config_);
  context.previous_sequence_num = published_sequence_num_;
  context.previous_stamp = map_.stamp;
  context.borders_are_checked = true;  // by the pipeline
  map_ = core::checked(std::move(built), context);
  published_sequence_num_ = map_.sequence_num;
  remarks_ = fault ? std::vector<std::string>() : pipeline_.remarks();
  if (!marker_fault_.empty()) remarks_.push_back(marker_fault_);
  if (map_.status.code == core::StatusCode::kOk) {
    map_.status.message = joined(remarks_);
  } else if (!marker_fault_.empty()) {
    map_.status.message += "; " + marker_fault_;
  }
  const MapMsgPtr message = to_message(map_);
  if (markers_) message->lane_marker = *markers_;
  if (localization_) message->localization = *localization_;
  return message;
}

void MapEngine::reset() {
  pipeline_.reset();
  localization_.reset();
  markers_.reset();
  localization_has_transform_ = true;
  marker_fault_.clear();
  newest_pose_.reset();
  mapped_pose_.reset();
}

}  // namespace relative_map
