#include "relative_map/prediction/prioritizer.hpp"

#include <gmock/gmock.h>

#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

class Priorities : public Watch {
 public:
  Priorities() { ego.pose = Pose2({50.0, 0.0}, 0.0); }
};

Priority priority_of(const Prediction& prediction, int id) {
  return user_of(prediction, id).priority;
}

TEST(Prioritizer, NearestAheadAndBehindNeedCaution) {
  Priorities watch;
  watch.watch(
      [](double t) {
        return std::vector<SeenRoadUser>{seen(1, 80.0 + t, 0.0), seen(2, 70.0 + t, 0.0),
                                         seen(3, 30.0 + t, 0.0), seen(4, 70.0 + t, 40.0)};
      },
      0.0, 1.0);
  const Prediction prediction = watch.predict(two_lanes());
  EXPECT_EQ(prediction.scenario, Scenario::kCruise);
  EXPECT_EQ(priority_of(prediction, 1), Priority::kNormal);
  EXPECT_EQ(priority_of(prediction, 2), Priority::kCaution);
  EXPECT_EQ(priority_of(prediction, 3), Priority::kCaution);
  EXPECT_EQ(priority_of(prediction, 4), Priority::kIgnore);
}

TEST(Prioritizer, WhoMergesIsInteractive) {
  TrafficLanes lanes = two_lanes();
  TrafficLane ramp;
  ramp.id = "ramp";
  ramp.center = {{20.0, -12.0}, {40.0, -7.0}, {60.0, -3.0}, {75.0, -0.6}, {80.0, 0.0}};
  lanes.lanes.push_back(ramp);
  TrafficLane after = straight_lane("after", 0.0, 80.0, 200.0);
  lanes.lanes[0] = straight_lane("right", 0.0, 0.0, 80.0);
  lanes.lanes[0].successors = lanes.lanes[2].successors = {"after"};
  lanes.lanes.push_back(after);
  Priorities watch;
  watch.watch(
      [](double t) { return std::vector<SeenRoadUser>{seen(1, 20.0 + 10.0 * t, -12.0 + 2.5 * t, 0.24)}; },
      0.0, 1.5);
  const Prediction prediction = watch.predict(lanes);
  EXPECT_EQ(priority_of(prediction, 1), Priority::kCaution);
  EXPECT_TRUE(user_of(prediction, 1).interactive);
}

TEST(Prioritizer, APedestrianWhoWillBeBesideTheLaneNeedsCaution) {
  Priorities watch;
  watch.watch(
      [](double t) {
        return std::vector<SeenRoadUser>{
            seen(1, 80.0, -9.0 + 1.2 * t, kPi / 2.0, RoadUserType::kPedestrian),
            seen(2, 80.0, -9.0 - 1.2 * t, -kPi / 2.0, RoadUserType::kPedestrian)};
      },
      0.0, 1.0);
  const Prediction prediction = watch.predict(two_lanes());
  EXPECT_EQ(priority_of(prediction, 1), Priority::kCaution);
  EXPECT_NE(priority_of(prediction, 2), Priority::kCaution);
}

TEST(Prioritizer, OfTooManyTheFarthestGoBackAndNoneStaysInteractive) {
  Priorities watch;
  const auto crowd = [](double) {
    std::vector<SeenRoadUser> users;
    for (int i = 0; i < 12; ++i)
      users.push_back(seen(i, 55.0 + 3.0 * i, -3.0, 0.0, RoadUserType::kPedestrian));
    return users;
  };
  watch.watch(crowd, 0.0, 1.0);
  for (int again = 0; again < 2; ++again) {
    const Prediction prediction = watch.predict(two_lanes());
    std::vector<int> caution;
    for (const PredictedRoadUser& user : prediction.users) {
      if (user.priority == Priority::kCaution) caution.push_back(user.seen.id);
      EXPECT_FALSE(user.interactive);
    }
    EXPECT_THAT(caution, testing::ElementsAre(0, 1, 2, 3, 4, 5));
  }
}

TEST(Scenario, AControlledJunctionAheadIsOne) {
  TrafficLanes lanes = two_lanes();
  JunctionArea junction;
  junction.border = {{58.0, -5.0}, {70.0, -5.0}, {70.0, 5.0}, {58.0, 5.0}};
  lanes.junctions = {junction};
  Priorities watch;
  watch.watch([](double) { return std::vector<SeenRoadUser>{}; }, 0.0, 0.1);
  EXPECT_EQ(watch.predict(lanes).scenario, Scenario::kCruise);
  lanes.junctions[0].controlled = true;
  EXPECT_EQ(watch.predict(lanes).scenario, Scenario::kJunction);
  watch.ego.pose = Pose2({40.0, 0.0}, 0.0);
  EXPECT_EQ(watch.predict(lanes).scenario, Scenario::kCruise);
  EXPECT_EQ(watch.predict({}).scenario, Scenario::kUnknown);
}

}  // namespace
}  // namespace relative_map::core::test
