#pragma once

#include <cmath>
#include <functional>
#include <random>
#include <stdexcept>

#include "relative_map/prediction/road_user_prediction.hpp"

// Road users and lanes from closed forms.
namespace relative_map::core::test {

inline SeenRoadUser seen(int id, double x, double y, double heading = 0.0,
                         RoadUserType type = RoadUserType::kVehicle) {
  SeenRoadUser user;
  user.id = id;
  user.type = type;
  user.position = {x, y};
  user.heading = heading;
  return user;
}

/// Straight along x at `y`.
inline TrafficLane straight_lane(const std::string& id, double y, double from = 0.0, double to = 200.0) {
  TrafficLane lane;
  lane.id = id;
  for (double x = from; x <= to; x += 5.0) lane.center.emplace_back(x, y);
  lane.left_width = lane.right_width = 1.75;
  return lane;
}

/// A part of a circle that begins at (x, y) in direction theta, left positive.
inline TrafficLane curved_lane(const std::string& id, double x, double y, double theta, double radius,
                               double length) {
  TrafficLane lane;
  lane.id = id;
  for (double s = 0.0; s <= length; s += 1.0) {
    const double angle = theta + s / radius;
    lane.center.emplace_back(x + radius * (std::sin(angle) - std::sin(theta)),
                             y - radius * (std::cos(angle) - std::cos(theta)));
  }
  lane.left_width = lane.right_width = 1.75;
  return lane;
}

/// Two lanes side by side: "right" along the x axis, "left" beside it.
inline TrafficLanes two_lanes() {
  TrafficLanes lanes;
  lanes.lanes = {straight_lane("right", 0.0), straight_lane("left", 3.5)};
  lanes.lanes[0].left_neighbor = "left";
  lanes.lanes[1].right_neighbor = "right";
  return lanes;
}

/// Where each road user is at a time [s].
using Traffic = std::function<std::vector<SeenRoadUser>(double)>;

/// Sees traffic at 10 Hz for a while, far from the vehicle itself.
class Watch {
 public:
  explicit Watch(const PredictionConfig& config = {}) : prediction(config) {
    ego.pose = Pose2({-1000.0, -1000.0}, 0.0);
  }

  void watch(const Traffic& traffic, double from, double to, double noise = 0.0, unsigned seed = 1) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    for (int i = 0; from + 0.1 * i <= to + 1e-6; ++i) {
      SeenRoadUsers frame;
      frame.stamp = at_seconds(1000.0 + from + 0.1 * i);
      frame.users = traffic(from + 0.1 * i);
      for (SeenRoadUser& user : frame.users) {
        const double dx = normal(random), dy = normal(random);
        user.position += noise * Point2(dx, dy);
      }
      prediction.see(frame, ego);
      now = frame.stamp;
    }
  }
  Prediction predict(const TrafficLanes& lanes = {}) {
    view = LaneView(lanes);
    return prediction.predict(now, ego, view);
  }

  RoadUserPrediction prediction;
  EgoVehicle ego;
  LaneView view;
  Time now{};
};

inline const PredictedRoadUser& user_of(const Prediction& prediction, int id) {
  for (const PredictedRoadUser& user : prediction.users) {
    if (user.seen.id == id) return user;
  }
  throw std::runtime_error("there is no such road user");
}

inline double probability_of(const PredictedRoadUser& user, const std::string& lane) {
  double sum = 0.0;
  for (const PredictedTrajectory& trajectory : user.trajectories) {
    if (trajectory.lane_id == lane) sum += trajectory.probability;
  }
  return sum;
}

}  // namespace relative_map::core::test
