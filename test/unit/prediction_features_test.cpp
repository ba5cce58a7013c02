#include <gmock/gmock.h>

#include "relative_map/prediction/features/ego_features.hpp"
#include "relative_map/prediction/features/history_features.hpp"
#include "relative_map/prediction/features/lane_polylines.hpp"
#include "relative_map/prediction/features/lane_raster.hpp"
#include "support/traffic.hpp"

namespace relative_map::core::test {
namespace {

TEST(HistoryFeatures, AreInItsOwnFrameNewestFirstAndSayHowManyAreGiven) {
  // North at 8 m/s, seen for 1 s every 0.2 s.
  const MotionFilterParam param;
  const auto at = [](double t) { return seen(1, 50.0, 8.0 * t, kPi / 2.0); };
  RoadUser user(at_seconds(0.0), at(0.0), 0.1, param);
  for (int i = 1; i <= 5; ++i) user.see(at_seconds(0.2 * i), at(0.2 * i), 0.1, param, 7.0);
  const HistoryFeatures features = history_features(user);
  EXPECT_EQ(features.given, 11);
  for (int i = 0; i < 11; ++i) {
    EXPECT_NEAR(features.positions(i, 0), -0.8 * i, 0.05) << i;
    EXPECT_NEAR(features.positions(i, 1), 0.0, 0.1) << i;
  }
  EXPECT_NEAR(features.steps(3, 0), 0.8, 0.01);
  EXPECT_TRUE(features.positions.bottomRows(9).isZero());
  EXPECT_TRUE(features.steps.row(0).isZero());
}

TEST(EgoFeatures, AreThePlanInTheFrameOfTheRoadUserOrNone) {
  EgoVehicle ego;
  EXPECT_FALSE(ego_features(ego, Pose2()));
  for (int i = 0; i <= 20; ++i) {  // every 0.2 s on a circle of 50 m, at 10 m/s
    TrajectoryPoint point;
    point.time = 0.2 * i;
    point.theta = 2.0 * i / 50.0;
    point.position = {50.0 * std::sin(point.theta), 50.0 * (1.0 - std::cos(point.theta))};
    point.speed = 10.0;
    point.acceleration = 0.5;
    ego.trajectory.push_back(point);
  }
  const auto features = ego_features(ego, Pose2({10.0, 5.0}, 0.3));
  ASSERT_TRUE(features);
  const double angle = 10.0 * 1.0 / 50.0;
  const Point2 place =
      Pose2({10.0, 5.0}, 0.3).to_local(Point2(50.0 * std::sin(angle), 50.0 * (1.0 - std::cos(angle))));
  EXPECT_NEAR((*features)(9, 0), place.x(), 0.02);
  EXPECT_NEAR((*features)(9, 1), place.y(), 0.02);
  EXPECT_NEAR((*features)(9, 2), angle - 0.3, 1e-6);
  EXPECT_NEAR((*features)(9, 3), 10.0, 1e-9);
  EXPECT_NEAR((*features)(9, 4), 0.5, 1e-9);
  EXPECT_NEAR((*features)(9, 5), 1.0 / 50.0, 1e-4);
  ego.trajectory.resize(10);  // 1.8 s only
  EXPECT_FALSE(ego_features(ego, Pose2()));
}

TEST(LanePolylines, AreVectorsOfFiveMetresWithinReach) {
  const LaneView lanes(two_lanes());
  const LanePolylines polylines = lane_polylines(lanes, Pose2({100.0, 0.0}, kPi / 2.0));
  EXPECT_EQ(polylines.lines, 6u);
  EXPECT_EQ(polylines.values.size(), kPolylines * kPolylineVectors * kVectorValues);
  const float* first = polylines.values.data();
  // The right lane's first vector: from 100 m behind, which is to the left of one that looks north.
  EXPECT_NEAR(first[0], 0.0, 1e-4);
  EXPECT_NEAR(first[1], 100.0, 1e-4);
  EXPECT_NEAR(first[2], 0.0, 1e-4);
  EXPECT_NEAR(first[3], 95.0, 1e-4);
  EXPECT_EQ(first[6], 1.0F);
  EXPECT_EQ(first[7], 0.0F);
  const float* left_boundary = first + kPolylineVectors * kVectorValues;
  EXPECT_NEAR(left_boundary[0], 1.75, 1e-4);
  EXPECT_EQ(left_boundary[6], 2.0F);
  EXPECT_EQ(left_boundary[7], 1.0F);
  EXPECT_EQ(left_boundary[8], 1.0F);
  for (std::size_t i = 0; i < polylines.mask.size(); ++i) {
    const bool empty = polylines.values[i * kVectorValues + 6] == 0.0F;
    ASSERT_EQ(polylines.mask[i] == 0, empty);
  }
  EXPECT_EQ(lane_polylines(lanes, Pose2({1000.0, 1000.0}, 0.0)).lines, 0u);
}

TEST(LanePolylines, TooManyAreLeftOut) {
  TrafficLanes many;
  for (int i = 0; i < 200; ++i) many.lanes.push_back(straight_lane(std::to_string(i), 0.1 * i, 0.0, 600.0));
  const LanePolylines polylines = lane_polylines(LaneView(many), Pose2({50.0, 0.0}, 0.0));
  EXPECT_EQ(polylines.lines, kPolylines);
}

TEST(LaneRaster, ShowsLanesCenterlinesAndRoadUsersWhereTheyAre) {
  const LaneView lanes(two_lanes());
  std::vector<Situation> situations;
  const MotionFilterParam param;
  const RoadUser user(at_seconds(0.0), seen(1, 110.0, 3.5), 0.1, param);
  situations.push_back(
      {&user, user.filter(), 0.0, 0.0, 0.0, 2.25, 0.9, {}, {}, {}, Priority::kNormal, false});
  const LaneRaster raster = lane_raster(lanes, situations, Pose2({100.0, 0.0}, 0.0));
  const double pixel = kRasterLength / kRasterSize;
  const auto at = [&](int plane, double x, double y) {
    return raster.at(plane, static_cast<int>((kRasterAhead - x) / pixel),
                     static_cast<int>((0.5 * kRasterLength - y) / pixel));
  };
  EXPECT_EQ(raster.pixels.size(), 3u * 224 * 224);
  EXPECT_EQ(at(0, 0.0, 0.0), 255);
  EXPECT_EQ(at(0, 29.0, 4.9), 255);
  EXPECT_EQ(at(0, 0.0, 5.6), 0);
  EXPECT_EQ(at(0, 0.0, -2.1), 0);
  EXPECT_EQ(at(1, 12.0, 3.5), 255);
  EXPECT_EQ(at(1, 12.0, 1.75), 0);
  EXPECT_EQ(at(2, 10.0, 3.5), 255);
  EXPECT_EQ(at(2, 12.0, 4.2), 255);
  EXPECT_EQ(at(2, 12.6, 3.5), 0);
  EXPECT_EQ(at(2, 10.0, 2.3), 0);
}

}  // namespace
}  // namespace relative_map::core::test
