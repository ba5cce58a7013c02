#pragma once

#include <relative_map/ADCTrajectory.h>
#include <relative_map/LocalizationEstimate.h>
#include <relative_map/MapMsg.h>
#include <relative_map/PerceptionObstacles.h>
#include <relative_map/PredictionObstacles.h>

#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "relative_map/pipeline/motion/pose_buffer.hpp"
#include "relative_map/prediction/lane_memory.hpp"
#include "relative_map/prediction/road_user_prediction.hpp"
#include "relative_map/ros/setup/frames.hpp"
#include "relative_map/ros/setup/prediction_parameters.hpp"

namespace relative_map {

/// Messages in, predictions out, without topics or timers: the node and the tool both drive it. Everything is
/// kept in the map frame, by the pose at each message's own stamp. Not thread-safe.
class PredictionEngine {
 public:
  PredictionEngine(const PredictionNodeConfig& config, LinkTransforms transforms);

  void on_localization(const LocalizationEstimateConstPtr& message, const ros::Time& received);
  void on_obstacles(const PerceptionObstaclesConstPtr& message, const ros::Time& received);
  void on_map(const MapMsgConstPtr& message, const ros::Time& received);
  void on_planning(const ADCTrajectoryConstPtr& message, const ros::Time& received);

  /// The prediction of the newest obstacles, once; none, where they had theirs. While there is something to
  /// complain of it is an empty one, at each tick. Time that runs backwards forgets all inputs.
  PredictionObstaclesPtr tick(const ros::Time& now);
  void reset();

  /// What the last tick noticed, a sentence each.
  const std::vector<std::string>& remarks() const { return remarks_; }

 private:
  /// The place of a message's frame in the map frame at its stamp; none: not known.
  std::optional<core::Pose2> map_from(const std::string& frame_id, core::Time stamp);
  void take_obstacles();
  std::optional<PredictionStatus> fault(const ros::Time& now) const;
  PredictionObstaclesPtr empty(const PredictionStatus& status, const ros::Time& now) const;
  PredictionObstaclesPtr predict(const ros::Time& now);
  core::EgoVehicle ego_at(core::Time stamp);

  PredictionNodeConfig config_;
  LinkTransforms transforms_;
  core::RoadUserPrediction prediction_;
  core::PoseBuffer poses_;
  std::optional<core::Time> newest_pose_;
  std::string map_frame_;
  std::string pose_fault_, frame_fault_;
  std::deque<PerceptionObstaclesConstPtr> waiting_;  ///< for the pose at their stamp
  std::optional<core::Time> newest_obstacles_;       ///< received
  std::optional<core::Time> seen_;                   ///< taken into the store
  std::optional<core::Time> predicted_;
  core::LaneMemory lane_memory_;
  core::LaneView lanes_;
  std::optional<core::Time> map_stamp_;
  ADCTrajectoryConstPtr planning_;
  ros::Time last_tick_;
  std::vector<std::string> remarks_;
};

}  // namespace relative_map
