// Maps whose errors are known by construction.
#include "relative_map/simulation/accuracy_metrics.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "relative_map/simulation/accuracy_row.hpp"
#include "relative_map/simulation/road.hpp"
#include "support/lines.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;

constexpr Time kStart(std::chrono::seconds(1000));
constexpr double kSpeed = 10.0;  // [m/s]

/// Lanes 3.5 m wide on a straight along x, and a vehicle that drives along it at offset l [m].
RecordedDrive straight_drive(std::size_t lanes, double l) {
  RecordedDrive drive;
  drive.road.path = make_drive_path(RoadShape().add_straight(400.0).lane(0.0, 0.5));
  const double half_width = 1.75;
  for (std::size_t i = 0; i <= lanes; ++i) {
    const double paint_l = half_width * (static_cast<double>(lanes) - 2.0 * static_cast<double>(i));
    drive.road.paint.push_back({paint_l});
    if (i < lanes) drive.road.lanes.push_back({paint_l - half_width, half_width, i, i + 1});
  }
  drive.start = kStart;
  for (int i = 0; i <= 4000; ++i) {
    const double s = kSpeed * 0.01 * i;
    drive.truth.push_back({kStart + std::chrono::milliseconds(10) * i, Pose2(Point2(s, l), 0.0), s, l});
  }
  drive.end = drive.truth.back().stamp;
  return drive;
}

/// The lane's border, `l` [m] beside the x axis of `base_from_lane`.
LaneBoundary border(const Pose2& base_from_lane, double l, double length) {
  LaneBoundary boundary;
  boundary.points = test::moved(test::straight(Pose2(Point2(-2.0, l), 0.0), length, 0.5), base_from_lane);
  return boundary;
}

/// A straight lane, seen from the vehicle.
RelativeMap map_of(double seconds, const Pose2& base_from_lane, double length = 100.0) {
  RelativeMap map;
  map.stamp = kStart + from_seconds(seconds);
  Lane lane;
  lane.id = map.current_lane_id = "a";
  lane.path = test::path_through(
      test::moved(test::straight(Pose2(Point2(-2.0, 0.0), 0.0), length, 0.5), base_from_lane));
  lane.length = lane.path.back().s;
  lane.remaining_distance = 1000.0;
  lane.left_boundary = border(base_from_lane, 1.75, length);
  lane.right_boundary = border(base_from_lane, -1.75, length);
  for (const PathPoint& point : lane.path) {
    lane.left_samples.push_back({point.s, 1.75});
    lane.right_samples.push_back({point.s, 1.75});
  }
  map.lanes.push_back(lane);
  return map;
}

TEST(AccuracyMeter, AShiftIsTheSameErrorEverywhere) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  const MapErrors errors = AccuracyMeter(drive).measure(map_of(5.0, Pose2(Point2(0.0, 0.2), 0.0)));
  for (const auto& error : errors.center) EXPECT_NEAR(error.value_or(kNaN), 0.2, 1e-9);
  EXPECT_NEAR(errors.left_boundary.value_or(kNaN), 0.2, 1e-9);
  EXPECT_NEAR(errors.right_boundary.value_or(kNaN), 0.2, 1e-9);
  EXPECT_NEAR(errors.left_half_width.value_or(kNaN), 0.0, 1e-9);
  EXPECT_NEAR(errors.heading.value_or(kNaN), 0.0, 1e-9);
  EXPECT_TRUE(errors.usable.value_or(false));
  EXPECT_FALSE(errors.jitter_10.has_value());

  const MapErrors other = AccuracyMeter(drive).measure(map_of(5.0, Pose2(Point2(0.0, -0.2), 0.0)));
  EXPECT_NEAR(other.center[3].value_or(kNaN), -0.2, 1e-9);
}

TEST(AccuracyMeter, ARotationIsAnErrorThatGrows) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  const double angle = 0.01;
  const MapErrors errors = AccuracyMeter(drive).measure(map_of(5.0, Pose2(Point2::Zero(), angle)));
  for (std::size_t i = 0; i < kErrorDistances.size(); ++i) {
    EXPECT_NEAR(errors.center[i].value_or(kNaN), kErrorDistances[i] * std::sin(angle), 1e-9);
  }
  EXPECT_NEAR(errors.heading.value_or(kNaN), angle, 1e-9);
}

TEST(AccuracyMeter, TheVehiclesOwnOffsetIsNoError) {
  const RecordedDrive drive = straight_drive(1, 0.6);
  const MapErrors errors = AccuracyMeter(drive).measure(map_of(5.0, Pose2(Point2(0.0, -0.6), 0.0)));
  for (const auto& error : errors.center) EXPECT_NEAR(error.value_or(kNaN), 0.0, 1e-9);
}

TEST(AccuracyMeter, WidthsAndBordersCountOnTheirOwn) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  RelativeMap map = map_of(5.0, Pose2());
  for (WidthSample& sample : map.lanes[0].left_samples) sample.width = 2.0;
  map.lanes[0].right_boundary = border(Pose2(), -1.65, 100.0);
  const MapErrors errors = AccuracyMeter(drive).measure(map);
  EXPECT_NEAR(errors.left_half_width.value_or(kNaN), 0.25, 1e-9);
  EXPECT_NEAR(errors.right_half_width.value_or(kNaN), 0.0, 1e-9);
  EXPECT_NEAR(errors.left_boundary.value_or(kNaN), 0.0, 1e-9);
  EXPECT_NEAR(errors.right_boundary.value_or(kNaN), 0.1, 1e-9);
}

TEST(AccuracyMeter, PaintThatHasLeftTheLaneIsNotItsBorder) {
  RecordedDrive drive = straight_drive(1, 0.0);
  drive.road.paint[0].shift = 3.5;
  drive.road.paint[0].from_s = 50.0;
  drive.road.paint[0].to_s = 80.0;
  const MapErrors errors = AccuracyMeter(drive).measure(map_of(5.0, Pose2()));  // at 50 m
  EXPECT_FALSE(errors.left_boundary.has_value());
  EXPECT_FALSE(errors.left_half_width.has_value());
  EXPECT_NEAR(errors.right_boundary.value_or(kNaN), 0.0, 1e-9);
  EXPECT_NEAR(errors.center[2].value_or(kNaN), 0.0, 1e-9);
}

TEST(AccuracyMeter, AMissingLaneCountsTwoMetres) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  RelativeMap map;
  map.stamp = kStart + from_seconds(5.0);
  const MapErrors errors = AccuracyMeter(drive).measure(map);
  for (const auto& error : errors.center) EXPECT_EQ(error.value_or(kNaN), 2.0);
  EXPECT_FALSE(errors.usable.value_or(true));
  EXPECT_FALSE(errors.heading.has_value());

  const MapErrors far = AccuracyMeter(drive).measure(map_of(5.0, Pose2(Point2(0.0, -7.0), 0.0)));
  EXPECT_EQ(far.center[2].value_or(kNaN), -2.0);
  EXPECT_FALSE(far.usable.value_or(true));
}

TEST(AccuracyMeter, AShortLaneIsNotUsable) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  RelativeMap map = map_of(5.0, Pose2(), 22.0);  // 20 m ahead
  MapErrors errors = AccuracyMeter(drive).measure(map);
  EXPECT_FALSE(errors.usable.value_or(true));
  EXPECT_NEAR(errors.center[3].value_or(kNaN), 0.0, 1e-9);
  EXPECT_EQ(errors.center[4].value_or(kNaN), 2.0);
  map.lanes[0].remaining_distance = 20.0;  // all that is left of the line
  EXPECT_TRUE(AccuracyMeter(drive).measure(map).usable.value_or(false));
}

TEST(AccuracyMeter, PastTheEndOfTheRoadNothingCounts) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  const MapErrors errors = AccuracyMeter(drive).measure(map_of(37.0, Pose2()));  // 30 m before it
  EXPECT_TRUE(errors.center[3].has_value());
  EXPECT_FALSE(errors.center[5].has_value());
}

TEST(AccuracyMeter, JitterIsWhatChangesBesidesTheMotion) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  AccuracyMeter meter(drive);
  meter.measure(map_of(5.0, Pose2()));
  MapErrors errors = meter.measure(map_of(5.1, Pose2()));
  EXPECT_NEAR(errors.jitter_10.value_or(kNaN), 0.0, 1e-9);
  errors = meter.measure(map_of(5.2, Pose2(Point2(0.0, 0.05), 0.0)));
  EXPECT_NEAR(errors.jitter_10.value_or(kNaN), 0.05, 1e-9);
  EXPECT_NEAR(errors.jitter_30.value_or(kNaN), 0.05, 1e-9);
  errors = meter.measure(map_of(5.3, Pose2(Point2(0.0, 0.05), 0.002)));
  EXPECT_NEAR(errors.jitter_10.value_or(kNaN), 0.02, 1e-4);
  EXPECT_NEAR(errors.jitter_30.value_or(kNaN), 0.06, 1e-4);
}

TEST(AccuracyMeter, TheLaneIsTheOneThatTheVehicleIsInAndNearTheBorderEither) {
  const Pose2 left_of_vehicle(Point2(0.0, 1.7), 0.0), right_of_vehicle(Point2(0.0, -1.8), 0.0);
  const RecordedDrive on_the_border = straight_drive(2, 0.05);  // lanes at 1.75 and -1.75
  for (const Pose2& lane : {left_of_vehicle, right_of_vehicle}) {
    const MapErrors errors = AccuracyMeter(on_the_border).measure(map_of(5.0, lane));
    EXPECT_NEAR(errors.center[2].value_or(kNaN), 0.0, 1e-9);
  }
  const RecordedDrive in_the_left_lane = straight_drive(2, 1.0);
  const MapErrors errors =
      AccuracyMeter(in_the_left_lane).measure(map_of(5.0, Pose2(Point2(0.0, -2.75), 0.0)));
  EXPECT_EQ(errors.center[2].value_or(kNaN), -2.0);
}

TEST(AccuracyMeter, AMapIsHeldAgainstWhatItClaims) {
  const RecordedDrive drive = straight_drive(1, 0.0);
  AccuracyMeter meter(drive);
  RelativeMap map = map_of(5.0, Pose2(Point2(0.0, 0.31), 0.0));
  EXPECT_FALSE(meter.measure(map).consistent) << "it claims nothing";
  map.fusion.lateral_offset.stddev = 0.1;
  EXPECT_EQ(meter.measure(map).consistent, false);
  map.fusion.lateral_offset.stddev = 0.104;
  EXPECT_EQ(meter.measure(map).consistent, true);
  map = map_of(5.0, Pose2(Point2(0.0, 8.0), 0.0));  // errors count 2 m at most, but not here
  map.fusion.lateral_offset.stddev = 1.0;
  EXPECT_EQ(meter.measure(map).consistent, false);
}

TEST(AccuracyRow, TellsSharesAndTheWorstSecond) {
  std::vector<MeasuredMap> drive(60);
  for (std::size_t i = 0; i < drive.size(); ++i) {
    drive[i].time = 0.1 * static_cast<double>(i);
    drive[i].errors.center[2] = i >= 30 && i < 40 ? -0.5 : 0.1;
    drive[i].errors.usable = i != 0;
    if (i < 50) drive[i].errors.consistent = i >= 5;
    drive[i].painted = i % 2 == 0;
  }
  AccuracyRow row, both;
  EXPECT_TRUE(std::isnan(row.worst_second));
  row.add(drive);
  EXPECT_NEAR(row.worst_second, 0.5, 1e-9);
  EXPECT_NEAR(row.usable_share(), 59.0 / 60.0, 1e-12);
  EXPECT_NEAR(row.consistent_share(), 0.9, 1e-12);
  EXPECT_NEAR(row.painted_share(), 0.5, 1e-12);
  for (MeasuredMap& map : drive) map.errors.center[2] = 0.2;
  row.add(drive);
  both.add(row);
  EXPECT_NEAR(both.worst_second, 0.5, 1e-9);
}

TEST(TrueRoad, LooksAheadAlongTheLaneNotTheRoad) {
  const double radius = 50.0;
  const RoadShape shape = RoadShape().add_arc(150.0, 1.0 / radius);
  TrueRoad road;
  road.path = make_drive_path(shape.lane(0.0, 0.1));
  road.lanes.push_back({10.0, 1.75, 0, 1});  // inside: of 40 m radius
  const auto places = road.ahead(road.lanes[0], 20.0, {0.0, 20.0, 60.0, 200.0});
  ASSERT_EQ(places.size(), 3u);
  for (std::size_t i = 0; i < 3; ++i) {
    const double s = 20.0 + (std::array<double, 3>{0.0, 20.0, 60.0})[i] * radius / 40.0;
    EXPECT_NEAR(places[i].s, s, 1e-2);
    EXPECT_LT((places[i].position + road.path.origin - shape.at(places[i].s, 10.0).position).norm(), 2e-3);
  }
}

}  // namespace
}  // namespace relative_map::core
