#include "relative_map/simulation/vehicle_simulation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <vector>

#include "relative_map/simulation/paint.hpp"
#include "relative_map/simulation/road.hpp"

namespace relative_map::core {
namespace {

constexpr double kStep = 0.01;  // [s]

VehicleSimulationConfig without_noise() {
  VehicleSimulationConfig config;
  config.noise = {0.0, 0.0, 0.0, 0.0, 0.0};
  return config;
}

VehicleSimulation on_demo_road(const VehicleSimulationConfig& config) {
  return {demo_road().lane(0.0, 0.4), config};
}

/// Drives until the end of the line, or for `max_time` [s].
void drive(
    VehicleSimulation& vehicle, double max_time, const std::function<void()>& at_each_step = [] {}) {
  while (!vehicle.at_end() && to_seconds(vehicle.time()) < max_time) {
    vehicle.step(kStep);
    at_each_step();
  }
}

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (double value : values) sum += value;
  return sum / static_cast<double>(values.size());
}

double standard_deviation(const std::vector<double>& values) {
  const double center = mean(values);
  double sum = 0.0;
  for (double value : values) sum += (value - center) * (value - center);
  return std::sqrt(sum / static_cast<double>(values.size()));
}

/// Everything that a run says, one number after the other.
std::vector<double> record(std::uint64_t seed) {
  VehicleSimulationConfig config;
  config.seed = seed;
  VehicleSimulation vehicle = on_demo_road(config);
  std::vector<double> numbers;
  drive(vehicle, 5.0, [&] {
    const Localization localization = vehicle.measure_localization();
    const LaneMarkers markers = vehicle.measure_lane_markers();
    numbers.insert(numbers.end(), {localization.position.x(), localization.position.y(), localization.heading,
                                   vehicle.measure_chassis().speed, markers.left.cubic.c0,
                                   markers.right.cubic.c1, vehicle.l()});
  });
  return numbers;
}

TEST(VehicleSimulation, TheSameSeedGivesTheSameRun) {
  EXPECT_EQ(record(7), record(7));
  EXPECT_NE(record(7), record(8));
}

TEST(VehicleSimulation, ASensorsNoiseDoesNotDependOnTheOthers) {
  VehicleSimulation one = on_demo_road({}), other = on_demo_road({});
  other.measure_lane_markers();
  other.measure_chassis();
  EXPECT_EQ(one.measure_localization().position, other.measure_localization().position);
}

TEST(VehicleSimulation, SpeedKeepsToItsLimits) {
  const VehicleSimulationConfig config = without_noise();
  VehicleSimulation vehicle = on_demo_road(config);
  double fastest = 0.0, slowest_in_sharp_curve = 1e9, speed_before = 0.0;
  drive(vehicle, 200.0, [&] {
    std::size_t vertex = 0;
    const double kappa = std::abs(interpolate(vehicle.path().points, vehicle.s(), vertex).kappa);
    const double lateral = vehicle.speed() * vehicle.speed() * kappa;
    EXPECT_LE(lateral, config.speed.max_lateral_acceleration * 1.05) << "at s = " << vehicle.s();
    const double acceleration = (vehicle.speed() - speed_before) / kStep;
    EXPECT_LE(acceleration, config.speed.max_acceleration + 1e-6);
    if (vehicle.speed() > 0.3) {  // the last millimetres are rough
      EXPECT_GE(acceleration, -config.speed.max_deceleration * 1.1) << "at s = " << vehicle.s();
    }
    speed_before = vehicle.speed();
    fastest = std::max(fastest, vehicle.speed());
    if (kappa > 0.99 / 60.0) slowest_in_sharp_curve = std::min(slowest_in_sharp_curve, vehicle.speed());
  });
  EXPECT_NEAR(fastest, config.speed.max_speed, 1e-9);
  EXPECT_NEAR(slowest_in_sharp_curve, std::sqrt(2.0 * 60.0), 0.1);
}

TEST(VehicleSimulation, StopsAtTheEndOfAnOpenLine) {
  VehicleSimulation vehicle = on_demo_road(without_noise());
  EXPECT_EQ(vehicle.path().ends, Ends::kOpen);
  double speed_before_end = 0.0;
  drive(vehicle, 300.0, [&] {
    if (!vehicle.at_end()) speed_before_end = vehicle.speed();
  });
  ASSERT_TRUE(vehicle.at_end());
  EXPECT_LT(speed_before_end, 0.2);
  EXPECT_EQ(vehicle.speed(), 0.0);
  EXPECT_NEAR(vehicle.s(), 1080.0, 0.1);  // of chords
  const Point2 there = vehicle.map_from_base().position();
  vehicle.step(1.0);
  EXPECT_EQ(vehicle.map_from_base().position(), there);
  EXPECT_EQ(vehicle.yaw_rate(), 0.0);

  vehicle.restart();
  EXPECT_FALSE(vehicle.at_end());
  EXPECT_EQ(vehicle.s(), 0.0);
  vehicle.step(1.0);
  EXPECT_GT(vehicle.speed(), 1.0);
}

TEST(VehicleSimulation, DrivesLapsOnAClosedLine) {
  VehicleSimulationConfig config = without_noise();
  config.start_s = 700.0;
  VehicleSimulation vehicle(closed_road(Pose2(Point2(691188.0, 3118142.0), 1.0)).lane(3.5, 0.5), config);
  EXPECT_EQ(vehicle.path().ends, Ends::kClosed);
  int laps = 0;
  double s_before = vehicle.s();
  Pose2 before = vehicle.map_from_base();
  drive(vehicle, 150.0, [&] {
    if (vehicle.s() < s_before) ++laps;
    s_before = vehicle.s();
    const Pose2 now = vehicle.map_from_base();
    EXPECT_NEAR((now.position() - before.position()).norm(), vehicle.speed() * kStep, 0.02) << vehicle.s();
    EXPECT_LT(std::abs(angle_difference(now.heading(), before.heading())), 0.01) << vehicle.s();
    before = now;
  });
  EXPECT_GE(laps, 2);
  EXPECT_GT(vehicle.speed(), 5.0);
  const LaneMarkers markers = vehicle.measure_lane_markers();
  EXPECT_GT(markers.left.quality, 0.0);
}

TEST(VehicleSimulation, MovesForwardAlongItsHeading) {
  VehicleSimulation vehicle = on_demo_road(without_noise());
  Pose2 before = vehicle.map_from_base();
  double turned = 0.0, farthest = 0.0;
  drive(vehicle, 60.0, [&] {
    const Pose2 now = vehicle.map_from_base();
    const Point2 moved = before.to_local(now.position());
    EXPECT_NEAR(moved.x(), vehicle.speed() * kStep, 1e-3);
    EXPECT_NEAR(moved.y(), 0.0, 2e-3);  // the line is a polyline
    turned += vehicle.yaw_rate() * kStep;
    farthest = std::max(farthest, std::abs(vehicle.l()));
    before = now;
  });
  EXPECT_NEAR(angle_difference(turned + on_demo_road(without_noise()).map_from_base().heading(),
                               vehicle.map_from_base().heading()),
              0.0, 1e-9);
  EXPECT_GT(farthest, 0.1);
  EXPECT_LE(farthest, 0.2);
}

TEST(VehicleSimulation, WithoutWanderItIsOnTheRoad) {
  const RoadShape road = demo_road();
  VehicleSimulationConfig config = without_noise();
  config.wander = 0.0;
  VehicleSimulation vehicle = on_demo_road(config);
  drive(vehicle, 200.0, [&] {
    const PathPoint truth = road.at(vehicle.s());  // s of chords: less by millimetres
    const Point2 apart = vehicle.map_from_base().position() - truth.position;
    EXPECT_NEAR(left_of(truth.direction).dot(apart), 0.0, 1e-3) << vehicle.s();
    EXPECT_NEAR(angle_difference(vehicle.map_from_base().heading(), truth.theta), 0.0, 1e-3) << vehicle.s();
  });
}

TEST(VehicleSimulation, MarkersLieOnThePaint) {
  const RoadShape road = demo_road();
  VehicleSimulation vehicle = on_demo_road(without_noise());
  double widest = 0.0, shortest = 1e9;
  drive(vehicle, 200.0, [&] {
    if (vehicle.s() > 1020.0) return;  // the paint ends
    const Pose2 base = vehicle.map_from_base();
    const LaneMarkers markers = vehicle.measure_lane_markers();
    EXPECT_EQ(markers.stamp, Time(vehicle.time()));
    for (const auto& [marker, l] : {std::pair(markers.left, 1.75), std::pair(markers.right, -1.75)}) {
      ASSERT_GT(marker.quality, 0.0);
      shortest = std::min(shortest, marker.view_range);
      for (double ahead = 0.0; ahead < 60.0; ahead += 5.0) {
        const Point2 paint = base.to_local(road.at(vehicle.s() + ahead, l).position);
        if (paint.x() < 0.0 || paint.x() > marker.view_range) continue;
        widest = std::max(widest, std::abs(marker.cubic.value(paint.x()) - paint.y()));
      }
    }
  });
  EXPECT_LT(widest, 0.06);
  EXPECT_LT(shortest, 45.0);  // a cubic does not follow the sharpest curve for long
  EXPECT_GT(shortest, 25.0);
}

TEST(VehicleSimulation, MarkersEndWithThePaint) {
  VehicleSimulationConfig config = without_noise();
  config.start_s = 1060.0;
  VehicleSimulation vehicle = on_demo_road(config);
  const LaneMarkers markers = vehicle.measure_lane_markers();
  EXPECT_GT(markers.right.quality, 0.0);
  EXPECT_NEAR(markers.right.view_range, 20.0, 1.1);
  drive(vehicle, 100.0);
  EXPECT_EQ(vehicle.measure_lane_markers().left.quality, 0.0);
  EXPECT_EQ(vehicle.measure_lane_markers().left.view_range, 0.0);
}

TEST(VehicleSimulation, NoiseIsOfTheSizeAskedFor) {
  VehicleSimulationConfig config;
  config.noise = {0.05, 0.01, 0.1, 0.03, 0.002};
  VehicleSimulation vehicle = on_demo_road(config);
  VehicleSimulation exact = on_demo_road(without_noise());
  vehicle.step(10.0);
  exact.step(10.0);
  const Pose2 truth = vehicle.map_from_base();
  const LaneMarkers paint = exact.measure_lane_markers();
  std::vector<double> x, y, heading, speed, c0, c1;
  for (int i = 0; i < 4000; ++i) {
    const Localization localization = vehicle.measure_localization();
    x.push_back(localization.position.x() - truth.position().x());
    y.push_back(localization.position.y() - truth.position().y());
    heading.push_back(angle_difference(localization.heading, truth.heading()));
    speed.push_back(vehicle.measure_chassis().speed - vehicle.speed());
    const LaneMarkers markers = vehicle.measure_lane_markers();
    c0.push_back(markers.left.cubic.c0 - paint.left.cubic.c0);
    c1.push_back(markers.right.cubic.c1 - paint.right.cubic.c1);
  }
  const auto expect_noise = [](const std::vector<double>& errors, double expected) {
    EXPECT_NEAR(standard_deviation(errors), expected, 0.06 * expected);
    EXPECT_NEAR(mean(errors), 0.0, 0.08 * expected);
  };
  expect_noise(x, 0.05);
  expect_noise(y, 0.05);
  expect_noise(heading, 0.01);
  expect_noise(speed, 0.1);
  expect_noise(c0, 0.03);
  expect_noise(c1, 0.002);
}

TEST(VehicleSimulation, LocalizationIsConsistent) {
  VehicleSimulation vehicle = on_demo_road(without_noise());
  vehicle.step(30.0);
  const Localization localization = vehicle.measure_localization();
  const Eigen::Vector3d forward = localization.map_from_body * Eigen::Vector3d::UnitX();
  EXPECT_NEAR(std::atan2(forward.y(), forward.x()), localization.heading, 1e-12);
  EXPECT_LT((localization.linear_velocity - vehicle.speed() * forward).norm(), 1e-12);
  EXPECT_EQ(localization.angular_velocity_body.z(), vehicle.yaw_rate());
  EXPECT_EQ(localization.stamp, Time(std::chrono::seconds(30)));
}

TEST(VehicleSimulation, FaultyConfigsAndLinesAreRefused) {
  VehicleSimulationConfig config;
  EXPECT_TRUE(config.validate().empty());
  config.speed.max_speed = 0.0;
  config.noise.marker_c0 = std::nan("");
  const std::vector<std::string> faults = config.validate();
  ASSERT_EQ(faults.size(), 2u);
  EXPECT_EQ(faults[0], "max_speed is 0, but must lie in [0.1, 100]");
  EXPECT_NE(faults[1].find("noise/marker_c0"), std::string::npos);
  EXPECT_THROW(on_demo_road(config), std::invalid_argument);

  config = {};
  config.start_s = 2000.0;
  EXPECT_THROW(on_demo_road(config), std::invalid_argument);
  EXPECT_THROW(VehicleSimulation(RecordedLine(), {}), std::invalid_argument);
}

TEST(FitCubic, FindsTheCubicBehindThePoints) {
  const Cubic truth{1.7, -0.02, 1e-3, -2e-5};
  Polyline points;
  for (double x = 0.0; x <= 50.0; x += 1.0) points.emplace_back(x, truth.value(x));
  const Cubic fitted = fit_cubic(points);
  EXPECT_NEAR(fitted.c0, truth.c0, 1e-10);
  EXPECT_NEAR(fitted.c1, truth.c1, 1e-11);
  EXPECT_NEAR(fitted.c2, truth.c2, 1e-12);
  EXPECT_NEAR(fitted.c3, truth.c3, 1e-13);
}

TEST(FitPaint, NeedsFourPoints) {
  EXPECT_EQ(fit_paint({}).range, 0.0);
  EXPECT_EQ(fit_paint({{0.0, 1.0}, {1.0, 1.0}, {2.0, 1.0}}).range, 0.0);
  EXPECT_EQ(fit_paint({{0.0, 1.0}, {1.0, 1.0}, {2.0, 1.0}, {3.0, 1.0}}).range, 3.0);
}

}  // namespace
}  // namespace relative_map::core
