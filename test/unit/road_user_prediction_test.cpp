#include "relative_map/prediction/road_user_prediction.hpp"

#include <gmock/gmock.h>

#include "relative_map/prediction/prediction_check.hpp"
#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

std::string faults_of(const Prediction& prediction) {
  std::string text;
  for (const PredictionFault& fault : check_prediction(prediction))
    text += fault.row + ": " + fault.what + "; ";
  return text;
}

/// One vehicle along x.
Traffic driving(double speed, double y = 0.0, double drift = 0.0) {
  return [=](double t) { return std::vector<SeenRoadUser>{seen(1, 20.0 + speed * t, y + drift * t)}; };
}

TEST(RoadUserPrediction, EachLaneIsJudgedByItsOwnOffset) {
  // As published, with the current lane's offset for all, a neighbour got 0.77 beside 0.74.
  Watch watch;
  watch.watch(driving(10.0), 0.0, 2.0);
  const PredictedRoadUser user = watch.predict(two_lanes()).users.front();
  EXPECT_EQ(user.lane_id, "right");
  EXPECT_GT(probability_of(user, "right"), 0.9);
  EXPECT_LT(probability_of(user, "left"), 0.1);
}

TEST(RoadUserPrediction, WhoDriftsToANeighbourIsExpectedThere) {
  Watch watch;
  watch.watch(driving(10.0, 0.4, 0.7), 0.0, 2.0);
  const PredictedRoadUser user = watch.predict(two_lanes()).users.front();
  EXPECT_EQ(user.trajectories.front().lane_id, "left");
  EXPECT_NEAR(user.trajectories.front().points.back().position.y(), 3.5, 0.5);
}

TEST(RoadUserPrediction, TheMirroredSceneHasTheMirroredFuture) {
  Watch watch, mirrored;
  watch.watch(driving(10.0, 0.5, 0.3), 0.0, 2.0);
  mirrored.watch(driving(10.0, -0.5, -0.3), 0.0, 2.0);
  TrafficLanes lanes = two_lanes(), other;
  other.lanes = {straight_lane("right", 0.0), straight_lane("left", -3.5)};
  const PredictedRoadUser a = watch.predict(lanes).users.front(), b = mirrored.predict(other).users.front();
  ASSERT_EQ(a.trajectories.size(), b.trajectories.size());
  for (std::size_t m = 0; m < a.trajectories.size(); ++m) {
    EXPECT_NEAR(a.trajectories[m].probability, b.trajectories[m].probability, 1e-9);
    for (std::size_t i = 0; i < kPredictionPoints; ++i) {
      EXPECT_NEAR(a.trajectories[m].points[i].position.y(), -b.trajectories[m].points[i].position.y(), 1e-6);
    }
  }
}

TEST(RoadUserPrediction, StandingOnesHaveAWayToo) {
  for (const RoadUserType type :
       {RoadUserType::kVehicle, RoadUserType::kPedestrian, RoadUserType::kBicycle, RoadUserType::kUnknown}) {
    for (const TrafficLanes& lanes : {two_lanes(), TrafficLanes()}) {
      Watch watch;
      watch.watch([&](double) { return std::vector<SeenRoadUser>{seen(1, 30.0, 0.0, 0.0, type)}; }, 0.0, 2.0);
      const Prediction prediction = watch.predict(lanes);
      const PredictedRoadUser& user = prediction.users.front();
      EXPECT_TRUE(user.still);
      ASSERT_GE(user.trajectories.size(), 2u);
      EXPECT_LT((user.trajectories[0].points.back().position - user.position).norm(), 0.1);
      EXPECT_GT((user.trajectories[1].points.back().position - user.position).norm(), 3.0);
      EXPECT_EQ(faults_of(prediction), "");
    }
  }
}

TEST(RoadUserPrediction, CarsDoNotPileUpAtALanesEnd) {
  Watch watch;
  watch.watch(
      [](double t) {
        return std::vector<SeenRoadUser>{seen(1, 150.0 + 15.0 * t, 0.0), seen(2, 120.0 + 15.0 * t, 0.0)};
      },
      0.0, 2.0);
  const Prediction prediction = watch.predict(two_lanes());
  const Point2 first = user_of(prediction, 1).trajectories[0].points.back().position;
  const Point2 second = user_of(prediction, 2).trajectories[0].points.back().position;
  EXPECT_NEAR(first.x(), 180.0 + 120.0, 5.0);
  EXPECT_GT(first.x() - second.x(), 20.0);
  EXPECT_NEAR(first.y(), 0.0, 0.5);
}

TEST(RoadUserPrediction, UncertaintyGrowsWithTimeAndBeyondTheLanesEnd) {
  Watch watch;
  watch.watch(driving(10.0), 0.0, 2.0, 0.2);
  const PredictedRoadUser user = watch.predict(two_lanes()).users.front();
  const auto& points = user.trajectories.front().points;
  for (std::size_t i = 1; i < points.size(); ++i) {
    EXPECT_GE(points[i].sigma_along, points[i - 1].sigma_along);
    EXPECT_GE(points[i].sigma_across, points[i - 1].sigma_across);
  }
  EXPECT_GT(points[0].sigma_along, 0.0);
}

TEST(RoadUserPrediction, NoiseIsNotHeldAsAnAcceleration) {
  // As published, finite differences held for 8 s missed by 78 m after 5 s with 0.2 m of noise.
  for (const TrafficLanes& lanes : {two_lanes(), TrafficLanes()}) {
    double sum = 0.0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
      Watch watch;
      watch.watch(driving(10.0), 0.0, 2.0, 0.2, seed);
      sum += std::abs(watch.predict(lanes).users.front().trajectories.front().points[50].position.x() - 90.0);
    }
    EXPECT_LT(sum / 20.0, 3.0);
  }
}

TEST(RoadUserPrediction, LastPointIsAtEightSeconds) {
  Watch watch;
  watch.watch(driving(10.0), 0.0, 2.0);
  const PredictedRoadUser user = watch.predict(two_lanes()).users.front();
  EXPECT_EQ(user.trajectories.front().points.size(), 81u);
  EXPECT_DOUBLE_EQ(user.trajectories.front().points.back().time, 8.0);
  EXPECT_LT((user.trajectories.front().points.front().position - user.position).norm(), 1e-6);
}

TEST(RoadUserPrediction, PredictingTwiceIsTheSame) {
  Watch watch;
  watch.ego.pose = Pose2({0.0, 0.0}, 0.0);
  for (int i = 0; i <= 80; ++i) {
    TrajectoryPoint point;
    point.time = 0.1 * i;
    point.position = {0.8 * i, 0.0};
    point.speed = 8.0;
    watch.ego.trajectory.push_back(point);
  }
  watch.watch(driving(10.0), 0.0, 2.0);
  const Prediction a = watch.predict(two_lanes()), b = watch.predict(two_lanes());
  EXPECT_EQ(watch.ego.trajectory.size(), 81u);  // the published one grew by each call
  EXPECT_EQ(a.users.front().trajectories.front().points.back().position,
            b.users.front().trajectories.front().points.back().position);
}

TEST(RoadUserPrediction, AUserAtTheOriginIsPredictedAsAnywhere) {
  Watch watch;
  watch.watch([](double t) { return std::vector<SeenRoadUser>{seen(1, 10.0 * (t - 2.0), 0.0)}; }, 0.0, 2.0);
  TrafficLanes lanes;
  lanes.lanes = {straight_lane("a", 0.0, -100.0, 200.0)};
  const PredictedRoadUser user = watch.predict(lanes).users.front();
  EXPECT_EQ(user.lane_id, "a");
  EXPECT_NEAR(user.trajectories.front().points.back().position.x(), 80.0, 1.0);
}

TEST(RoadUserPrediction, OthersOrderDoesNotMatter) {
  const auto both = [](bool swapped) {
    return [swapped](double t) {
      std::vector<SeenRoadUser> users{seen(1, 60.0 + 5.0 * t, 0.0), seen(2, 20.0 + 12.0 * t, 0.2),
                                      seen(3, 10.0 + 9.0 * t, 3.5)};
      if (swapped) std::swap(users[0], users[2]);
      return users;
    };
  };
  Watch a, b;
  a.watch(both(false), 0.0, 2.0);
  b.watch(both(true), 0.0, 2.0);
  const Prediction one = a.predict(two_lanes()), other = b.predict(two_lanes());
  for (const int id : {1, 2, 3}) {
    EXPECT_EQ(user_of(one, id).trajectories[0].points[80].position,
              user_of(other, id).trajectories[0].points[80].position);
  }
}

TEST(RoadUserPrediction, TurningTheWorldTurnsTheFuture) {
  const Pose2 turned({500.0, -300.0}, 2.1);
  const auto traffic = [](double t) {
    return std::vector<SeenRoadUser>{seen(1, 60.0 + 5.0 * t, 0.0), seen(2, 20.0 + 12.0 * t, 0.2),
                                     seen(3, 40.0, 8.0 - 1.3 * t, -kPi / 2.0, RoadUserType::kPedestrian)};
  };
  Watch plain, other;
  plain.watch(traffic, 0.0, 2.0);
  other.ego.pose = turned.to_parent(plain.ego.pose);
  other.watch(
      [&](double t) {
        std::vector<SeenRoadUser> users = traffic(t);
        for (SeenRoadUser& user : users) {
          user.position = turned.to_parent(user.position);
          user.heading = normalize_angle(user.heading + turned.heading());
        }
        return users;
      },
      0.0, 2.0);
  TrafficLanes lanes = two_lanes(), turned_lanes = two_lanes();
  for (TrafficLane& lane : turned_lanes.lanes) {
    for (Point2& point : lane.center) point = turned.to_parent(point);
  }
  const Prediction a = plain.predict(lanes), b = other.predict(turned_lanes);
  for (const int id : {1, 2, 3}) {
    const auto &one = user_of(a, id).trajectories, &two = user_of(b, id).trajectories;
    ASSERT_EQ(one.size(), two.size());
    for (std::size_t m = 0; m < one.size(); ++m) {
      EXPECT_NEAR(one[m].probability, two[m].probability, 1e-6);
      for (const std::size_t i : {0u, 30u, 80u}) {
        EXPECT_LT((turned.to_parent(one[m].points[i].position) - two[m].points[i].position).norm(), 1e-3);
      }
    }
  }
}

TEST(RoadUserPrediction, NavigationModeServesEverybodyToo) {
  // As published, interactive vehicles and those off the lanes got the empty predictor.
  PredictionConfig config;
  config.selection = "navi";
  Watch watch(config);
  watch.ego.pose = Pose2({10.0, 0.0}, 0.0);
  watch.watch(
      [](double t) {
        return std::vector<SeenRoadUser>{seen(1, 30.0 + 8.0 * t, 0.0), seen(2, 30.0 + 8.0 * t, 30.0),
                                         seen(3, 30.0, 5.0 - 1.2 * t, -1.57, RoadUserType::kPedestrian)};
      },
      0.0, 2.0);
  const Prediction prediction = watch.predict(two_lanes());
  EXPECT_EQ(faults_of(prediction), "");
  for (const PredictedRoadUser& user : prediction.users)
    EXPECT_THAT(user.trajectories, testing::Not(IsEmpty()));
}

TEST(RoadUserPrediction, WhateverComesInKeepsEveryRow) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> place(-50.0, 150.0), angle(-10.0, 10.0), odd(0.0, 1.0);
  TrafficLanes lanes = two_lanes();
  lanes.lanes.push_back(curved_lane("bend", 100.0, 0.0, 0.0, 8.0, 20.0));
  for (unsigned run = 0; run < 5; ++run) {
    Watch watch;
    watch.ego.pose = Pose2({50.0, 0.0}, 0.0);
    watch.watch(
        [&](double t) {
          std::vector<SeenRoadUser> users;
          for (int i = 0; i < 40; ++i) {
            SeenRoadUser user = seen(i % 35, place(random), place(random) / 5.0, angle(random),
                                     static_cast<RoadUserType>(i % 6));
            if (i % 3 == 0) user.position = {10.0 + 3.0 * i + (i - 20.0) * t, 0.3 * i * std::sin(t)};
            if (odd(random) < 0.05) user.position.x() = kNotGiven;
            if (odd(random) < 0.05) user.heading = kNotGiven;
            if (odd(random) < 0.05) user.velocity = {1000.0, -1000.0};
            if (odd(random) < 0.05) user.length = 0.0;
            users.push_back(user);
          }
          return users;
        },
        0.0, 2.0, 0.3, run);
    for (const TrafficLanes& map : {lanes, TrafficLanes(), two_lanes()}) {
      EXPECT_EQ(faults_of(watch.predict(map)), "");
    }
  }
}

TEST(RoadUserPrediction, AConfigurationWithFaultsIsRefused) {
  PredictionConfig config;
  config.lane.preview_time = -1.0;
  config.selection = "best";
  try {
    RoadUserPrediction prediction(config);
    FAIL();
  } catch (const std::invalid_argument& fault) {
    EXPECT_THAT(fault.what(), HasSubstr("lane/preview_time"));
    EXPECT_THAT(fault.what(), HasSubstr("'best'"));
  }
}

}  // namespace
}  // namespace relative_map::core::test
