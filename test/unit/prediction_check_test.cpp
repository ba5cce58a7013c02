#include "relative_map/prediction/prediction_check.hpp"

#include <gmock/gmock.h>

#include <functional>
#include <set>

namespace relative_map::core {
namespace {

/// One that drives straight on at 10 m/s.
Prediction sound() {
  Prediction prediction;
  PredictedRoadUser user;
  PredictedTrajectory trajectory;
  trajectory.probability = 1.0;
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    TrajectoryPoint point;
    point.time = kPredictionStep * static_cast<double>(i);
    point.position = {10.0 * point.time, 0.0};
    point.speed = 10.0;
    point.sigma_along = point.sigma_across = 1.0;
    trajectory.points.push_back(point);
  }
  user.trajectories.push_back(trajectory);
  prediction.users.push_back(user);
  return prediction;
}

TEST(PredictionCheck, ASoundOnePasses) {
  EXPECT_TRUE(check_prediction(sound()).empty());
}

TEST(PredictionCheck, EveryRowIsBrokenByWhatItIsThereFor) {
  using Break = std::function<void(PredictedRoadUser&, std::vector<TrajectoryPoint>&)>;
  const std::vector<std::pair<std::string, Break>> breaks = {
      {"finite", [](auto&, auto& points) { points[5].sigma_along = std::nan(""); }},
      {"times", [](auto&, auto& points) { points[5].time = 0.45; }},
      {"times", [](auto&, auto& points) { points.pop_back(); }},
      {"start",
       [](auto& user, auto&) {
         user.position = {1.0, 0.0};
       }},
      {"speed", [](auto&, auto& points) { points[5].speed = -0.1; }},
      {"speed", [](auto&, auto& points) { points[5].speed = 20.0; }},
      {"theta", [](auto&, auto& points) { points[5].theta = 0.5; }},
      {"acceleration", [](auto&, auto& points) { points[5].acceleration = -12.0; }},
      {"turn",
       [](auto&, auto& points) {
         for (std::size_t i = 0; i < points.size(); ++i) {
           const double angle = 2.0 * points[i].time;  // a radius of 5 m at 10 m/s
           points[i].position = {5.0 * std::sin(angle), 5.0 - 5.0 * std::cos(angle)};
           points[i].theta = normalize_angle(angle);
         }
       }},
      {"forward",
       [](auto&, auto& points) {
         for (TrajectoryPoint& point : points) point.theta = kPi;
       }},
      {"probabilities", [](auto& user, auto&) { user.trajectories[0].probability = 0.7; }},
      {"probabilities", [](auto& user, auto&) { user.trajectories[0].probability = 1.2; }},
      {"every road user", [](auto& user, auto&) { user.trajectories.clear(); }},
  };
  std::set<std::string> broken;
  for (const auto& [row, damage] : breaks) {
    Prediction prediction = sound();
    damage(prediction.users[0], prediction.users[0].trajectories[0].points);
    std::vector<std::string> rows;
    for (const PredictionFault& fault : check_prediction(prediction)) rows.push_back(fault.row);
    EXPECT_THAT(rows, testing::Contains(row));
    broken.insert(row);
  }
  const std::vector<std::string> all = prediction_check_rows();
  EXPECT_EQ(broken, std::set<std::string>(all.begin(), all.end()));
}

TEST(PredictionCheck, AUTurnOnTheSpotIsNone) {
  Prediction prediction = sound();
  auto& points = prediction.users[0].trajectories[0].points;
  for (TrajectoryPoint& point : points) {
    point.position = {0.3 * std::abs(1.0 - point.time), 0.0};
    point.theta = point.time < 1.0 ? kPi : 0.0;
    point.speed = 0.3;
  }
  prediction.users[0].position = {0.3, 0.0};
  std::vector<std::string> rows;
  for (const PredictionFault& fault : check_prediction(prediction)) rows.push_back(fault.row);
  EXPECT_THAT(rows, testing::Contains("turn"));
}

}  // namespace
}  // namespace relative_map::core
