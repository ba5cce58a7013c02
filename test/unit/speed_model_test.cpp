#include "relative_map/prediction/speed_model.hpp"

#include <gmock/gmock.h>

#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

const SpeedParam kParam;

TEST(Drive, KeepsItsSpeedOnAFreeStraight) {
  const SpeedProfile profile = drive({12.0, 0.0, 0.0, 0.0}, nullptr, nullptr, kParam);
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    EXPECT_NEAR(profile.v[i], 12.0, 1e-12);
    EXPECT_NEAR(profile.s[i], 1.2 * static_cast<double>(i), 1e-9);
  }
}

TEST(Drive, AnAccelerationFadesAndIsNeverHeld) {
  const SpeedProfile profile = drive({10.0, 2.0, 0.0, 0.0}, nullptr, nullptr, kParam);
  // The speed gains a * time in the end, not a * 8 s.
  EXPECT_NEAR(profile.v.back(),
              10.0 + 2.0 * kParam.acceleration_time * (1.0 - std::exp(-8.0 / kParam.acceleration_time)),
              0.15);
  EXPECT_LT(profile.a.back(), 0.1);
}

TEST(Drive, StopsAndStandsAndNeverGoesBack) {
  const SpeedProfile profile = drive({3.0, -5.0, 0.0, 0.0}, nullptr, nullptr, kParam);
  EXPECT_EQ(profile.v.back(), 0.0);
  for (std::size_t i = 1; i < kPredictionPoints; ++i) EXPECT_GE(profile.s[i], profile.s[i - 1]);
}

TEST(Drive, NeverRunsIntoItsLeader) {
  const SpeedProfile standing = drive({0.0, 0.0, 0.0, 0.0}, nullptr, nullptr, kParam);
  for (const double speed : {5.0, 10.0, 15.0}) {
    const LeadingVehicle leader{3.0 * speed, &standing};
    const SpeedProfile profile = drive({speed, 0.0, 0.0, 0.0}, &leader, nullptr, kParam);
    EXPECT_LT(profile.s.back(), 3.0 * speed) << speed;
    EXPECT_LT(profile.v.back(), 1.0) << speed;
  }
}

TEST(Drive, FollowsALeaderThatGetsFasterAndKeepsItsHeadway) {
  const SpeedProfile faster = drive({10.0, 1.5, 0.0, 0.0}, nullptr, nullptr, kParam);
  const LeadingVehicle leader{12.0, &faster};
  const SpeedProfile profile = drive({10.0, 0.0, 0.0, 0.0}, &leader, nullptr, kParam);
  EXPECT_GT(profile.v.back(), 11.0);
  const SpeedProfile same = drive({10.0, 0.0, 0.0, 0.0}, nullptr, nullptr, kParam);
  const LeadingVehicle ahead{12.5, &same};
  EXPECT_NEAR(drive({10.0, 0.0, 0.0, 0.0}, &ahead, nullptr, kParam).v.back(), 10.0, 0.1);
}

TEST(Drive, BrakesForACurveInTime) {
  TrafficLanes lanes;
  lanes.lanes = {straight_lane("in", 0.0, 0.0, 60.0), curved_lane("bend", 60.0, 0.0, 0.0, 12.0, 18.0)};
  lanes.lanes[0].successors = {"bend"};
  const LaneView view(lanes);
  LaneSequence path(view, {0, 0.0, 0.0, 0.0});
  path.append(1);
  const CurveLimits curves(path, 0.0, 150.0, 3.0, 2.0);
  const SpeedProfile profile = drive({14.0, 0.0, 0.0, 0.0}, nullptr, &curves, kParam);
  for (std::size_t i = 0; i < kPredictionPoints; ++i) {
    if (profile.s[i] > 64.0 && profile.s[i] < 75.0) {
      EXPECT_LT(profile.v[i], std::sqrt(3.0 * 12.0) + 1.0);
    }
    EXPECT_GT(profile.a[i], -4.0);
  }
  EXPECT_GT(profile.s.back(), 60.0);
  EXPECT_NEAR(braking_for_curves(path, 0.0, 14.0, 100.0, 3.0), (14.0 * 14.0 - 36.0) / 2.0 / 62.0, 0.25);
}

}  // namespace
}  // namespace relative_map::core::test
