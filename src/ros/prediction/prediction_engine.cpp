#include "relative_map/ros/prediction/prediction_engine.hpp"

#include <algorithm>
#include <boost/make_shared.hpp>
#include <cmath>

#include "relative_map/pipeline/motion/input_check.hpp"
#include "relative_map/pipeline/motion/vehicle_state.hpp"
#include "relative_map/ros/prediction/prediction_messages.hpp"

namespace relative_map {

namespace {

constexpr std::size_t kMaxWaiting = 10;  // frames
constexpr double kMaxPlanningAge = 1.0;  // [s]
constexpr double kMaxFuture = 0.5;       // [s] that a stamp may be ahead of the clock

core::Pose2 planar(const Eigen::Isometry3d& transform) {
  const Eigen::Vector3d forward = transform.rotation() * Eigen::Vector3d::UnitX();
  return {transform.translation().head<2>(), std::atan2(forward.y(), forward.x())};
}

/// A stamp that was not filled is the time of arrival.
core::Time stamp_of(const std_msgs::Header& header, const ros::Time& received) {
  return to_core(header.stamp.isZero() ? received : header.stamp);
}

std::string joined(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : "; ") + sentence;
  return text;
}

PredictionStatus status(std::uint8_t code, const std::string& message) {
  PredictionStatus result;
  result.code = code;
  result.message = message;
  return result;
}

}  // namespace

PredictionEngine::PredictionEngine(const PredictionNodeConfig& config, LinkTransforms transforms)
    : config_(config),
      transforms_(std::move(transforms)),
      prediction_(config.prediction, load_network(config.prediction)) {}

void PredictionEngine::on_localization(const LocalizationEstimateConstPtr& message,
                                       const ros::Time& received) {
  const std::string link =
      message->child_frame_id.empty() ? config_.base_frame : frame_name(message->child_frame_id);
  const ros::Time at = message->header.stamp.isZero() ? received : message->header.stamp;
  const std::optional<Eigen::Isometry3d> link_from_base = transforms_(link, config_.base_frame, at);
  pose_fault_.clear();
  if (!link_from_base) {
    pose_fault_ =
        "no transform from localization's child_frame_id '" + link + "' to '" + config_.base_frame + "'";
    return;
  }
  const auto checked = core::check_localization(to_core(*message, config_.orientation_convention, received));
  if (checked.refusal) {
    pose_fault_ = checked.refusal->message;
    return;
  }
  const core::Localization base =
      link == config_.base_frame ? checked.input : core::carry_to_base(checked.input, *link_from_base);
  const auto state = core::make_vehicle_state(base, std::nullopt);
  if (const core::Status* refused = std::get_if<core::Status>(&state)) {
    pose_fault_ = refused->message;
    return;
  }
  poses_.add(std::get<core::VehicleState>(state));
  newest_pose_ = base.stamp;
  map_frame_ = frame_name(message->header.frame_id);
}

void PredictionEngine::on_obstacles(const PerceptionObstaclesConstPtr& message, const ros::Time& received) {
  auto stamped = message;
  if (message->header.stamp.isZero()) {
    auto copy = boost::make_shared<PerceptionObstacles>(*message);
    copy->header.stamp = received;
    stamped = copy;
  }
  waiting_.push_back(stamped);
  if (waiting_.size() > kMaxWaiting) waiting_.pop_front();
  newest_obstacles_ = to_core(stamped->header.stamp);
}

std::optional<core::Pose2> PredictionEngine::map_from(const std::string& frame_id, core::Time stamp) {
  const std::string frame = frame_id.empty() ? config_.base_frame : frame_name(frame_id);
  if (frame == map_frame_ && !map_frame_.empty()) return core::Pose2();
  const std::optional<Eigen::Isometry3d> base_from_frame =
      transforms_(config_.base_frame, frame, to_ros(stamp));
  if (!base_from_frame) {
    frame_fault_ = "no transform from '" + frame + "' to '" + config_.base_frame + "'";
    return std::nullopt;
  }
  frame_fault_.clear();
  const std::optional<core::Pose2> map_from_base = poses_.at(stamp);
  if (!map_from_base) return std::nullopt;
  return map_from_base->to_parent(planar(*base_from_frame));
}

void PredictionEngine::on_map(const MapMsgConstPtr& message, const ros::Time& received) {
  const core::Time stamp = stamp_of(message->header, received);
  const std::optional<core::Pose2> map_from_base = poses_.at(stamp);
  // An empty one is no map: the last one stands until it is too old.
  if (!map_from_base || message->hdmap.lane.empty()) return;
  lanes_ = core::LaneView(lane_memory_.remember(to_traffic_lanes(*message, *map_from_base)));
  map_stamp_ = stamp;
}

void PredictionEngine::on_planning(const ADCTrajectoryConstPtr& message, const ros::Time&) {
  planning_ = message;
}

core::EgoVehicle PredictionEngine::ego_at(core::Time stamp) {
  core::EgoVehicle ego;
  if (const auto pose = poses_.at(stamp)) ego.pose = *pose;
  if (newest_pose_ && std::isfinite(poses_.newest().speed)) ego.speed = poses_.newest().speed;
  if (!planning_ || std::abs(core::to_seconds(to_core(planning_->header.stamp) - stamp)) > kMaxPlanningAge) {
    return ego;
  }
  if (const auto place = map_from(planning_->header.frame_id, to_core(planning_->header.stamp))) {
    ego.trajectory = to_core(*planning_, *place, stamp);
    ego.right_of_way_is_sure = planning_->right_of_way_status == ADCTrajectory::PROTECTED;
  }
  return ego;
}

void PredictionEngine::take_obstacles() {
  while (!waiting_.empty()) {
    const PerceptionObstaclesConstPtr message = waiting_.front();
    const core::Time stamp = to_core(message->header.stamp);
    const auto place = map_from(message->header.frame_id, stamp);
    if (!place) {
      // The pose of that time may still come; one from before all poses never will.
      if (newest_pose_ && stamp < *newest_pose_) {
        remarks_.push_back("obstacles are dropped: there is no pose for their stamp");
        waiting_.pop_front();
        continue;
      }
      return;
    }
    prediction_.see(to_core(*message, *place, stamp), ego_at(stamp));
    for (const std::string& remark : prediction_.store().remarks()) remarks_.push_back(remark);
    seen_ = prediction_.store().newest();
    waiting_.pop_front();
  }
}

std::optional<PredictionStatus> PredictionEngine::fault(const ros::Time& now) const {
  const auto age = [&](core::Time stamp) { return core::to_seconds(to_core(now) - stamp); };
  if (!pose_fault_.empty()) {
    const bool transform = pose_fault_.rfind("no transform", 0) == 0;
    return status(transform ? PredictionStatus::NO_TRANSFORM : PredictionStatus::INVALID_LOCALIZATION,
                  pose_fault_);
  }
  if (!newest_pose_) return status(PredictionStatus::NO_LOCALIZATION, "no localization was received yet");
  if (age(*newest_pose_) > config_.max_localization_age) {
    return status(PredictionStatus::STALE_LOCALIZATION,
                  "localization is " + core::seconds_text(to_core(now) - *newest_pose_) + " old");
  }
  if (age(*newest_pose_) < -kMaxFuture) {
    return status(PredictionStatus::INVALID_LOCALIZATION, "localization: header.stamp is ahead of the clock");
  }
  if (!frame_fault_.empty()) return status(PredictionStatus::NO_TRANSFORM, frame_fault_);
  if (!newest_obstacles_) return status(PredictionStatus::NO_OBSTACLES, "no obstacles were received yet");
  if (!seen_ || age(*seen_) > config_.prediction.store.max_age) {
    return status(PredictionStatus::STALE_OBSTACLES, "no obstacles of late");
  }
  return std::nullopt;
}

PredictionObstaclesPtr PredictionEngine::empty(const PredictionStatus& status, const ros::Time& now) const {
  auto message = boost::make_shared<PredictionObstacles>();
  message->header.stamp = now;
  message->header.frame_id = config_.publish_in_map_frame ? map_frame_ : config_.base_frame;
  message->status = status;
  return message;
}

PredictionObstaclesPtr PredictionEngine::predict(const ros::Time& now) {
  const bool map_is_of_now =
      map_stamp_ && core::to_seconds(to_core(now) - *map_stamp_) <= config_.max_map_age;
  if (!map_is_of_now && map_stamp_) {
    lanes_ = core::LaneView();
    lane_memory_.clear();
    map_stamp_.reset();
  }
  const core::EgoVehicle ego = ego_at(*seen_);
  const core::Prediction prediction = prediction_.predict(*seen_, ego, lanes_);
  for (const std::string& remark : prediction.remarks) {
    if (std::find(remarks_.begin(), remarks_.end(), remark) == remarks_.end()) remarks_.push_back(remark);
  }
  const core::Pose2 frame = config_.publish_in_map_frame ? core::Pose2() : ego.pose;
  PredictionObstaclesPtr message = to_message(prediction, frame);
  message->header.stamp = to_ros(*seen_);
  message->header.frame_id = config_.publish_in_map_frame ? map_frame_ : config_.base_frame;
  message->status = map_is_of_now
                        ? status(PredictionStatus::OK, joined(remarks_))
                        : status(PredictionStatus::NO_MAP, "no map of late: everybody goes straight on");
  for (PredictionObstacle& obstacle : message->prediction_obstacle)
    obstacle.timestamp = message->header.stamp;
  return message;
}

PredictionObstaclesPtr PredictionEngine::tick(const ros::Time& now) {
  if (now < last_tick_) reset();
  last_tick_ = now;
  remarks_.clear();
  if (pose_fault_.empty() && newest_pose_) take_obstacles();
  if (const auto found = fault(now)) return empty(*found, now);
  if (predicted_ == seen_) return nullptr;
  predicted_ = seen_;
  return predict(now);
}

void PredictionEngine::reset() {
  prediction_.reset();
  poses_.clear();
  newest_pose_.reset();
  pose_fault_.clear();
  frame_fault_.clear();
  waiting_.clear();
  newest_obstacles_.reset();
  seen_.reset();
  predicted_.reset();
  lane_memory_.clear();
  lanes_ = core::LaneView();
  map_stamp_.reset();
  planning_.reset();
}

}  // namespace relative_map
