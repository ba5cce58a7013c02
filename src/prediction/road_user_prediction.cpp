#include "relative_map/prediction/road_user_prediction.hpp"

#include <algorithm>
#include <stdexcept>

#include "relative_map/prediction/prediction_check.hpp"
#include "relative_map/prediction/prioritizer.hpp"
#include "relative_map/prediction/situation_builder.hpp"
#include "relative_map/prediction/speed_model.hpp"

namespace relative_map::core {

namespace {

PredictionConfig checked(const PredictionConfig& config) {
  std::string text;
  for (const std::string& fault : config.validate()) text += "\n  - " + fault;
  if (!text.empty()) throw std::invalid_argument("the configuration of prediction is refused:" + text);
  return config;
}

}  // namespace

RoadUserPrediction::RoadUserPrediction(const PredictionConfig& config, std::shared_ptr<const Network> network)
    : config_(checked(config)), store_(config.store, config.filter), selection_(config, std::move(network)) {}

namespace {

constexpr double kEgoReach = 3.0;  // [m] to the lane that the vehicle is on

const Service& service_of(const SelectionTable& selection, const Situation& situation) {
  const Surrounding on_lane = situation.interactive ? Surrounding::kInteractive : Surrounding::kOnLane;
  return selection.find(situation.user->type(), situation.options.empty() ? Surrounding::kOffLane : on_lane);
}

PredictedRoadUser described(const Situation& situation, const LaneView& lanes) {
  PredictedRoadUser user;
  user.seen = situation.user->seen();
  user.seen.type = situation.user->type();
  user.position = situation.position();
  user.velocity = situation.filter.velocity();
  user.theta = situation.theta;
  user.still = situation.still();
  user.priority = situation.priority;
  user.interactive = situation.interactive;
  if (situation.best() != nullptr) user.lane_id = lanes.lanes()[situation.best()->path.place().lane].id;
  return user;
}

/// Leaves out what breaks a row; the others share its probability.
std::size_t drop_faulty(PredictedRoadUser& user) {
  auto& all = user.trajectories;
  const std::size_t before = all.size();
  all.erase(std::remove_if(all.begin(), all.end(),
                           [&](const PredictedTrajectory& trajectory) {
                             return !check_trajectory(user, trajectory).empty();
                           }),
            all.end());
  double sum = 0.0;
  for (const PredictedTrajectory& trajectory : all) sum += trajectory.probability;
  for (PredictedTrajectory& trajectory : all) {
    trajectory.probability = sum > 0.0 ? trajectory.probability / sum : 1.0 / static_cast<double>(all.size());
  }
  return before - all.size();
}

}  // namespace

Prediction RoadUserPrediction::predict(Time now, const EgoVehicle& ego, const LaneView& lanes) const {
  Prediction prediction;
  prediction.stamp = now;
  prediction.remarks = store_.remarks();
  std::vector<LanePlace> ego_places;
  lanes.places(ego.pose.position(), kEgoReach, ego_places);
  prediction.scenario = analyze_scenario(lanes, ego, ego_places, config_.priority);
  std::vector<Situation> situations = build_situations(store_.present(now), now, lanes, config_);
  const SpeedProfile ego_profile = profile_of(ego);
  const PredictionContext context{now, config_, lanes, ego, ego_profile, ego_places, situations};
  for (Situation& situation : situations) {
    selection_.evaluator(service_of(selection_, situation).evaluator).evaluate(context, situation);
  }
  prioritize(situations, lanes, ego, ego_places, config_.priority);
  find_leaders(situations, lanes, ego, ego_places, config_.speed);
  drive_all(situations, ego_profile, config_.lane.lateral_acceleration, config_.speed);
  std::size_t dropped = 0;
  prediction.users.reserve(situations.size());
  for (const Situation& situation : situations) {
    PredictedRoadUser user = described(situation, lanes);
    user.trajectories =
        selection_.predictor(service_of(selection_, situation).predictor).predict(context, situation);
    dropped += drop_faulty(user);
    // What no rule has a way for goes straight on.
    if (user.trajectories.empty()) {
      user.trajectories =
          selection_.predictor("extrapolation").predict(context, Situation(situation).without_lanes());
    }
    prediction.users.push_back(std::move(user));
  }
  if (dropped > 0) {
    prediction.remarks.push_back(std::to_string(dropped) +
                                 " trajectories that nothing could drive were left out");
  }
  return prediction;
}

}  // namespace relative_map::core
