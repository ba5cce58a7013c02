#include "relative_map/ros/prediction/prediction_messages.hpp"

#include <boost/make_shared.hpp>
#include <cmath>

#include "relative_map/ros/messages/conversions.hpp"

namespace relative_map {

namespace {

core::Point2 planar(const geometry_msgs::Point& point) {
  return {point.x, point.y};
}

double mean_width(const std::vector<LaneSampleAssociation>& samples) {
  double sum = 0.0;
  for (const LaneSampleAssociation& sample : samples) sum += sample.width;
  return samples.empty() ? 0.0 : sum / static_cast<double>(samples.size());
}

core::LaneUse use_of(const Lane& lane) {
  switch (lane.type) {
    case Lane::BIKING:
      return core::LaneUse::kBicycles;
    case Lane::SIDEWALK:
      return core::LaneUse::kPedestrians;
    case Lane::PARKING:
      return core::LaneUse::kParking;
    default:
      return core::LaneUse::kVehicles;
  }
}

std::string first_of(const std::vector<std::string>& ids) {
  return ids.empty() ? "" : ids.front();
}

}  // namespace

core::SeenRoadUsers to_core(const PerceptionObstacles& message, const Pose2& map_from_frame,
                            core::Time stamp) {
  core::SeenRoadUsers frame;
  frame.stamp = stamp;
  frame.users.reserve(message.perception_obstacle.size());
  for (const PerceptionObstacle& obstacle : message.perception_obstacle) {
    core::SeenRoadUser user;
    user.id = obstacle.id;
    user.type = obstacle.type <= PerceptionObstacle::VEHICLE ? static_cast<core::RoadUserType>(obstacle.type)
                                                             : core::RoadUserType::kUnknown;
    user.position = map_from_frame.to_parent(planar(obstacle.position));
    user.heading = core::normalize_angle(obstacle.theta + map_from_frame.heading());
    user.velocity = map_from_frame.rotate_to_parent({obstacle.velocity.x, obstacle.velocity.y});
    // Zeros in all of them: a detector that has no velocities. One that stands is seen to stand all the same.
    if (user.velocity.isZero()) user.velocity.setConstant(core::kNotGiven);
    user.length = obstacle.length;
    user.width = obstacle.width;
    user.height = obstacle.height;
    const double variance = 0.5 * (obstacle.position_covariance[0] + obstacle.position_covariance[4]);
    if (variance > 0.0) user.position_stddev = std::sqrt(variance);
    frame.users.push_back(user);
  }
  return frame;
}

core::TrafficLanes to_traffic_lanes(const MapMsg& message, const Pose2& map_from_base) {
  core::TrafficLanes lanes;
  for (const Lane& source : message.hdmap.lane) {
    core::TrafficLane lane;
    lane.id = source.id;
    for (const CurveSegment& segment : source.central_curve.segment) {
      for (const geometry_msgs::Point& point : segment.line_segment.point) {
        lane.center.push_back(map_from_base.to_parent(planar(point)));
      }
    }
    lane.left_width = mean_width(source.left_sample);
    lane.right_width = mean_width(source.right_sample);
    lane.speed_limit = source.speed_limit;
    lane.use = use_of(source);
    lane.in_junction = !source.junction_id.empty();
    lane.successors = source.successor_id;
    lane.predecessors = source.predecessor_id;
    lane.left_neighbor = first_of(source.left_neighbor_forward_lane_id);
    lane.right_neighbor = first_of(source.right_neighbor_forward_lane_id);
    lanes.lanes.push_back(std::move(lane));
  }
  lanes.ego_lane = message.current_lane_id;
  for (const LaneNavigationPath& path : message.navigation_path) {
    if (path.navigation_path.path_priority == 0) lanes.ego_targets.push_back(path.lane_id);
  }
  return lanes;
}

std::vector<core::TrajectoryPoint> to_core(const ADCTrajectory& message, const Pose2& map_from_frame,
                                           core::Time now) {
  const double offset = core::to_seconds(to_core(message.header.stamp) - now);
  std::vector<core::TrajectoryPoint> points;
  for (const TrajectoryPoint& source : message.trajectory_point) {
    core::TrajectoryPoint point;
    point.time = source.relative_time + offset;
    point.position = map_from_frame.to_parent({source.path_point.x, source.path_point.y});
    point.theta = core::normalize_angle(source.path_point.theta + map_from_frame.heading());
    point.speed = source.v;
    point.acceleration = source.a;
    // Only what is still to come, by rising time.
    const bool rises = points.empty() || point.time > points.back().time;
    if (point.position.allFinite() && std::isfinite(point.speed) && point.time >= 0.0 && rises) {
      points.push_back(point);
    }
  }
  return points;
}

PredictionObstaclesPtr to_message(const core::Prediction& prediction, const Pose2& map_from_frame) {
  auto message = boost::make_shared<PredictionObstacles>();
  message->scenario = static_cast<std::uint8_t>(prediction.scenario);
  message->prediction_obstacle.reserve(prediction.users.size());
  for (const core::PredictedRoadUser& user : prediction.users) {
    message->prediction_obstacle.emplace_back();
    PredictionObstacle& obstacle = message->prediction_obstacle.back();
    PerceptionObstacle& seen = obstacle.perception_obstacle;
    seen.id = user.seen.id;
    seen.type = static_cast<std::uint8_t>(user.seen.type);
    const core::Point2 position = map_from_frame.to_local(user.position);
    const core::Point2 velocity = map_from_frame.rotate_to_local(user.velocity);
    seen.position.x = position.x();
    seen.position.y = position.y();
    seen.velocity.x = velocity.x();
    seen.velocity.y = velocity.y();
    seen.theta = core::angle_difference(user.theta, map_from_frame.heading());
    seen.length = user.seen.length;
    seen.width = user.seen.width;
    seen.height = user.seen.height;
    obstacle.priority = static_cast<std::uint8_t>(user.priority);
    obstacle.is_static = user.still;
    obstacle.is_interactive = user.interactive;
    obstacle.lane_id = user.lane_id;
    obstacle.predicted_period = core::kPredictionStep * static_cast<double>(core::kPredictionPoints - 1);
    obstacle.trajectory.reserve(user.trajectories.size());
    for (const core::PredictedTrajectory& source : user.trajectories) {
      obstacle.trajectory.emplace_back();
      PredictionTrajectory& trajectory = obstacle.trajectory.back();
      trajectory.probability = source.probability;
      trajectory.lane_id = source.lane_id;
      trajectory.trajectory_point.resize(source.points.size());
      double s = 0.0;
      for (std::size_t i = 0; i < source.points.size(); ++i) {
        const core::TrajectoryPoint& from = source.points[i];
        TrajectoryPoint& to = trajectory.trajectory_point[i];
        const core::Point2 local = map_from_frame.to_local(from.position);
        if (i > 0) s += (from.position - source.points[i - 1].position).norm();
        to.path_point.x = local.x();
        to.path_point.y = local.y();
        to.path_point.theta = core::angle_difference(from.theta, map_from_frame.heading());
        to.path_point.kappa = to.path_point.dkappa = to.path_point.ddkappa = core::kNotGiven;
        to.path_point.s = s;
        to.v = from.speed;
        to.a = from.acceleration;
        to.relative_time = from.time;
        to.sigma_along = from.sigma_along;
        to.sigma_across = from.sigma_across;
      }
    }
  }
  return message;
}

core::Prediction to_core(const PredictionObstacles& message) {
  core::Prediction prediction;
  prediction.stamp = to_core(message.header.stamp);
  for (const PredictionObstacle& obstacle : message.prediction_obstacle) {
    core::PredictedRoadUser user;
    user.seen.id = obstacle.perception_obstacle.id;
    user.position = planar(obstacle.perception_obstacle.position);
    user.theta = obstacle.perception_obstacle.theta;
    user.still = obstacle.is_static;
    for (const PredictionTrajectory& source : obstacle.trajectory) {
      core::PredictedTrajectory trajectory;
      trajectory.probability = source.probability;
      trajectory.lane_id = source.lane_id;
      for (const TrajectoryPoint& from : source.trajectory_point) {
        core::TrajectoryPoint point;
        point.time = from.relative_time;
        point.position = {from.path_point.x, from.path_point.y};
        point.theta = from.path_point.theta;
        point.speed = from.v;
        point.acceleration = from.a;
        point.sigma_along = from.sigma_along;
        point.sigma_across = from.sigma_across;
        trajectory.points.push_back(point);
      }
      user.trajectories.push_back(std::move(trajectory));
    }
    prediction.users.push_back(std::move(user));
  }
  return prediction;
}

}  // namespace relative_map
