// The estimator, seen through the pipeline: drives in closed form with one error at a time.

#include "relative_map/pipeline/estimation/lane_estimator.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "support/straight_drive.hpp"

namespace relative_map::core {
namespace {

using test::current;
using test::kHalfWidth;
using test::Scene;
using test::StraightDrive;
using test::y_at;

TEST(LaneEstimator, TakesLocalizationsOffsetOutWithinASecond) {
  StraightDrive drive;
  drive.bias = {0.0, 0.8};
  const RelativeMap map = drive.drive(10);
  EXPECT_EQ(map.fusion.source, Source::kFused);
  EXPECT_EQ(map.fusion.method, "estimator");
  for (const double ahead : {0.0, 10.0, 30.0}) EXPECT_NEAR(drive.error(map, ahead), 0.0, 0.05) << ahead;
  EXPECT_NEAR(map.fusion.lateral_offset.value, 0.8, 0.1);
  EXPECT_GT(map.fusion.lateral_offset.stddev, 0.0);
  EXPECT_LT(map.fusion.lateral_offset.stddev, 0.3);
}

TEST(LaneEstimator, TakesLocalizationsHeadingErrorOut) {
  StraightDrive drive;
  drive.heading_bias = 0.01;
  const RelativeMap map = drive.drive(30);
  for (const double ahead : {0.0, 10.0, 30.0, 45.0}) EXPECT_NEAR(drive.error(map, ahead), 0.0, 0.06) << ahead;
  EXPECT_NEAR(map.fusion.heading_offset.value, 0.01, 0.003);
}

TEST(LaneEstimator, LearnsTheLanesWidth) {
  StraightDrive drive;
  drive.half_width = 1.6;
  const RelativeMap map = drive.drive(20);
  EXPECT_NEAR(map.fusion.left_half_width.value, 1.6, 0.02);
  EXPECT_NEAR(map.fusion.right_half_width.value, 1.6, 0.02);
  for (const WidthSample& sample : current(map).left_samples)
    EXPECT_NEAR(sample.width, 1.6, 0.03) << sample.s;
}

TEST(LaneEstimator, OneSideIsEnough) {
  StraightDrive drive;
  drive.bias = {0.0, -0.5};
  drive.drive(10);
  RelativeMap map;
  for (int i = 0; i < 50; ++i) {
    LaneMarkers markers = drive.paint();
    markers.right.quality = 0.0;
    drive.bias.y() += 0.01;
    map = drive.tick(markers);
  }
  EXPECT_EQ(map.fusion.source, Source::kFused);
  EXPECT_NEAR(drive.error(map, 10.0), 0.0, 0.05);
}

TEST(LaneEstimator, WithOneLineTheLaneIsFoundHoweverFarOffLocalizationPutsIt) {
  for (const double bias : {-5.0, -3.5, -3.1, -2.5, -1.9, -1.4, 1.4, 1.9, 2.5, 3.1, 3.5, 5.0}) {
    StraightDrive drive;
    drive.bias = {0.0, bias};
    const RelativeMap map = drive.drive(20);  // two seconds
    EXPECT_EQ(map.fusion.source, Source::kFused) << bias;
    EXPECT_NEAR(drive.error(map, 10.0), 0.0, 0.1) << bias;
  }
}

TEST(LaneEstimator, AJumpOfLocalizationDoesNotMoveTheLane) {
  StraightDrive drive;
  drive.drive(20);
  drive.bias = {0.3, 1.0};
  for (int i = 0; i < 30; ++i) EXPECT_NEAR(drive.error(drive.drive(1), 10.0), 0.0, 0.06) << i;
}

TEST(LaneEstimator, WithoutPaintTheOffsetFades) {
  PipelineConfig config;
  config.lane_fusion.decay_time = 5.0;
  StraightDrive drive(config);
  drive.bias = {0.0, 1.0};
  drive.drive(30);
  RelativeMap map;
  for (int i = 0; i < 9; ++i) map = drive.tick();
  EXPECT_NEAR(map.fusion.lateral_offset.value, 1.0, 0.06);  // odometry holds it
  double last = map.fusion.lateral_offset.value, stddev = map.fusion.lateral_offset.stddev;
  for (int second = 0; second < 20; ++second) {
    for (int i = 0; i < 10; ++i) map = drive.tick();
    EXPECT_LT(map.fusion.lateral_offset.value, last + 1e-6) << second;
    last = map.fusion.lateral_offset.value;
  }
  EXPECT_LT(last, 0.7);
  EXPECT_GT(map.fusion.lateral_offset.stddev, stddev);
  EXPECT_LT(std::abs(drive.error(map, 0.0)), 3.0 * map.fusion.lateral_offset.stddev);
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
}

TEST(LaneEstimator, WithoutPaintTheWidthGoesBackToWhatIsExpected) {
  PipelineConfig config;
  config.lane_fusion.decay_time = 2.0;
  StraightDrive drive(config);
  drive.half_width = 1.5;
  RelativeMap map = drive.drive(30);
  EXPECT_NEAR(map.fusion.left_half_width.value, 1.5, 0.02);
  for (int i = 0; i < 100; ++i) map = drive.tick();
  EXPECT_NEAR(map.fusion.left_half_width.value, kHalfWidth, 0.01);
}

TEST(LaneEstimator, ForgetsWhenTheVehicleIsPutElsewhere) {
  StraightDrive drive;
  drive.bias = {0.0, 0.8};
  drive.drive(20);
  drive.x += 500.0;
  drive.bias = Point2::Zero();
  const RelativeMap map = drive.tick();
  EXPECT_NEAR(drive.error(map, 10.0), 0.0, 1e-9);
  EXPECT_EQ(map.fusion.source, Source::kNavigationLine);
}

TEST(LaneEstimator, TellsHowFarAlongTheLineTheVehicleIsWhereTheLineBends) {
  // Straight, then an arc that the paint shows 2 m sooner than localization expects it.
  Polyline points = test::straight(Pose2(), 100.0, 1.0);
  const Polyline bend = test::arc(Pose2(Point2(100.0, 0.0), 0.0), 0.02, 80.0, 1.0);
  points.insert(points.end(), bend.begin() + 1, bend.end());
  Scene scene({test::recording(points)});
  const auto on_road = [](double s) {
    return s < 100.0 ? Pose2(Point2(s, 0.0), 0.0)
                     : test::along_arc(Pose2(Point2(100.0, 0.0), 0.0), 0.02, s - 100.0);
  };
  RelativeMap map;
  for (double s = 20.0; s < 150.0; s += 1.0) {
    const Pose2 truth = on_road(s);
    LaneMarkers markers;
    for (const double side : {1.0, -1.0}) {
      Eigen::MatrixX4d powers(21, 4);
      Eigen::VectorXd y(21);
      for (int i = 0; i <= 20; ++i) {
        const Pose2 ahead = on_road(s + i);
        const Point2 p = truth.to_local(ahead.position() + side * kHalfWidth * left_of(ahead.forward()));
        powers.row(i) << 1.0, p.x(), p.x() * p.x(), p.x() * p.x() * p.x();
        y[i] = p.y();
      }
      const Eigen::Vector4d c = powers.colPivHouseholderQr().solve(y);
      (side > 0 ? markers.left : markers.right) = test::marker({c[0], c[1], c[2], c[3]}, 18.0);
    }
    scene.see(markers);
    const Pose2 localized(truth.position() - 2.0 * Point2(1.0, 0.0), truth.heading());  // 2 m too far back
    map = scene.at(localized);
  }
  const Point2 along = on_road(149.0).forward();
  EXPECT_NEAR(map.fusion.longitudinal_offset.value, 2.0 * along.x(), 0.4);
  EXPECT_LT(map.fusion.longitudinal_offset.stddev, 0.5);
}

TEST(LaneEstimator, ALaneChangeMovesTheStateToTheNeighbourWithoutAWobble) {
  Scene scene(test::three_straight_lines());
  const Point2 bias(0.0, 0.4);
  for (int i = 0; i < 150; ++i) {
    const double t = std::clamp((i - 40) / 50.0, 0.0, 1.0), y = 3.5 * t * t * (3.0 - 2.0 * t);
    const double slope = 3.5 * 6.0 * t * (1.0 - t) / 50.0;
    const double lane_y = y < 1.75 ? 0.0 : 3.5;  // which lane the camera takes for the vehicle's own
    const double heading = std::atan(slope);
    scene.see(test::lane_about({(lane_y - y) / std::cos(heading), -slope, 0.0, 0.0},
                               kHalfWidth / std::cos(heading)));
    const RelativeMap map = scene.at(Pose2(Point2(20.0 + i, y) + bias, heading));
    if (i < 10) continue;
    const double lane = map.current_lane_id == "middle" ? 0.0 : 3.5;
    EXPECT_NEAR(y_at(map, 10.0), (lane - y) / std::cos(heading) - slope * 10.0, 0.06) << i;
  }
}

TEST(LaneEstimator, PaintBeyondTheNeighboursTellsTheirFarBorders) {
  Scene scene(test::three_straight_lines());
  RelativeMap map;
  for (int i = 0; i < 20; ++i) {
    LaneMarkers markers = test::lane_about({0.0});
    markers.next_left = {
        test::marker({kHalfWidth + 3.9})};  // a lane of 3.9 m, its line 1.75 m from the near border
    markers.next_left[0].type = BoundaryType::kSolidYellow;
    scene.see(markers);
    map = scene.at(Pose2(Point2(50.0 + i, 0.0), 0.0));
  }
  ASSERT_EQ(map.lanes.size(), 3u);
  EXPECT_NEAR(map.lanes[0].left_samples.front().width, 3.9 - kHalfWidth, 0.03);
  EXPECT_EQ(map.lanes[0].left_boundary.paint.at(1).type, BoundaryType::kSolidYellow);
  EXPECT_NEAR(map.lanes[2].right_samples.front().width, kHalfWidth, 1e-6) << "nothing was seen there";
  EXPECT_EQ(map.lanes[2].right_boundary.paint.size(), 1u);
}

TEST(LaneEstimator, PredictsTheMapToTheTick) {
  PipelineConfig config;
  config.predict_to_tick = true;
  Scene scene(test::three_straight_lines(), config);
  scene.at(Pose2(Point2(50.0, 0.0), 0.0), 10.0);
  scene.wait(0.2);
  const RelativeMap map = scene.tick();
  EXPECT_EQ(map.stamp, scene.now());
  EXPECT_NEAR(current(map).remaining_distance, 600.0 - 52.0, 1e-6);
}

}  // namespace
}  // namespace relative_map::core