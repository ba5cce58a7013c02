// Lane changes, stops, reversing, and paint that is not parallel to the lane.
#include <gtest/gtest.h>

#include <cmath>

#include "relative_map/simulation/road.hpp"
#include "relative_map/simulation/vehicle_simulation.hpp"

namespace relative_map::core {
namespace {

constexpr double kStep = 0.01;  // [s]

VehicleSimulationConfig exact() {
  VehicleSimulationConfig config;
  config.noise = {0.0, 0.0, 0.0, 0.0, 0.0};
  config.wander = 0.0;
  config.paint.lines = {{5.25, BoundaryType::kSolidWhite},
                        {1.75, BoundaryType::kDottedWhite},
                        {-1.75, BoundaryType::kSolidYellow}};
  return config;
}

VehicleSimulation on_straight(const VehicleSimulationConfig& config) {
  return {RoadShape().add_straight(1000.0).lane(0.0, 0.5), config};
}

TEST(Manoeuvres, ALaneChangeIsSmoothAndMovesTheMarkers) {
  VehicleSimulationConfig config = exact();
  config.lane_changes = {{100.0, 60.0, 3.5}};
  VehicleSimulation vehicle = on_straight(config);
  double heading_before = 0.0, l_before = 0.0, sharpest = 0.0;
  while (vehicle.s() < 250.0) {
    vehicle.step(kStep);
    const Pose2 pose = vehicle.map_from_base();
    EXPECT_TRUE(vehicle.s() > 100.0 || vehicle.l() == 0.0);
    EXPECT_TRUE(vehicle.s() < 160.0 || std::abs(vehicle.l() - 3.5) < 1e-9);
    EXPECT_NEAR(pose.position().y(), vehicle.l(), 1e-9);
    EXPECT_GE(vehicle.l(), l_before);
    if (vehicle.speed() > 1.0) {
      const double ahead = vehicle.speed() * kStep;
      EXPECT_NEAR(vehicle.l() - l_before, ahead * std::sin(0.5 * (pose.heading() + heading_before)), 1e-3);
      sharpest = std::max(sharpest, std::abs(vehicle.yaw_rate()) / vehicle.speed());
    }
    l_before = vehicle.l();
    heading_before = pose.heading();
    const LaneMarkers markers = vehicle.measure_lane_markers();
    const bool changed = vehicle.l() > 1.75;
    EXPECT_NEAR(markers.left.cubic.c0, (changed ? 5.25 : 1.75) - vehicle.l(), 0.1);
    EXPECT_NEAR(markers.right.cubic.c0, (changed ? 1.75 : -1.75) - vehicle.l(), 0.1);
    EXPECT_EQ(markers.left.type, changed ? BoundaryType::kSolidWhite : BoundaryType::kDottedWhite);
    EXPECT_EQ(markers.next_left.size(), changed ? 0u : 1u);
    EXPECT_EQ(markers.next_right.size(), changed ? 1u : 0u);
  }
  EXPECT_LT(sharpest, 0.008);  // 10 / sqrt(3) * 3.5 / 60^2 = 0.0056 [1/m]
  EXPECT_GT(sharpest, 0.004);
}

TEST(Manoeuvres, SpeedFollowsTheDriversWishBackwardsToo) {
  VehicleSimulationConfig config = exact();
  config.speed_changes = {{20.0, 0.0}, {32.0, -2.0}, {42.0, 0.0}};
  VehicleSimulation vehicle = on_straight(config);
  vehicle.step(20.0);
  EXPECT_NEAR(vehicle.speed(), config.speed.max_speed, 1e-9);
  vehicle.step(11.9);
  EXPECT_EQ(vehicle.speed(), 0.0);
  const double standing_s = vehicle.s();
  while (to_seconds(vehicle.time()) < 36.0) vehicle.step(kStep);
  EXPECT_NEAR(vehicle.speed(), -2.0, 1e-9);
  EXPECT_LT(vehicle.measure_chassis().speed, -1.9);
  EXPECT_LT(vehicle.measure_localization().linear_velocity.x(), -1.9);
  EXPECT_LT(vehicle.s(), standing_s - 4.0);
  EXPECT_NEAR(vehicle.map_from_base().position().x(), vehicle.s(), 1e-9);
  EXPECT_NEAR(vehicle.map_from_base().heading(), 0.0, 1e-9);
  vehicle.step(10.0);
  EXPECT_EQ(vehicle.speed(), 0.0);
}

TEST(Manoeuvres, StopsWhereItIsToldTo) {
  VehicleSimulationConfig config = exact();
  config.stop_s = 300.0;
  VehicleSimulation vehicle = on_straight(config);
  vehicle.step(60.0);
  EXPECT_NEAR(vehicle.s(), 300.0, 0.55);  // at a vertex
  EXPECT_LT(vehicle.speed(), 0.1);
  EXPECT_FALSE(vehicle.at_end());
  EXPECT_GT(vehicle.measure_lane_markers().left.view_range, 45.0);  // the paint goes on
}

TEST(Manoeuvres, PaintLeavesItsPlaceAndComesBack) {
  PaintLine line;
  line.l = -1.75;
  line.shift = -3.5;
  line.from_s = 300.0;
  line.to_s = 360.0;
  line.ramp = 40.0;
  EXPECT_EQ(line.l_at(259.0), -1.75);
  EXPECT_NEAR(line.l_at(280.0), -3.5, 1e-12);
  EXPECT_EQ(line.l_at(300.0), -5.25);
  EXPECT_EQ(line.l_at(330.0), -5.25);
  EXPECT_NEAR(line.l_at(380.0), -3.5, 1e-12);
  EXPECT_EQ(line.l_at(401.0), -1.75);
}

TEST(Manoeuvres, PaintOutOfSightRoundABendIsNotSeen) {
  VehicleSimulationConfig config = exact();
  config.paint.lines.clear();
  const double radius = 40.0;
  const RecordedLine arc = RoadShape().add_arc(150.0, 1.0 / radius).lane(0.0, 0.1);
  const auto range = [&](double max_turn) {
    config.paint.max_turn = max_turn;
    return VehicleSimulation(arc, config).measure_lane_markers().right.view_range;
  };
  EXPECT_NEAR(range(0.6), (radius + 1.75) * std::sin(0.6), 1.1);
  EXPECT_NEAR(range(0.3), (radius + 1.75) * std::sin(0.3), 1.1);
}

TEST(Manoeuvres, ErrorsArePartOfWhatTheSensorsSay) {
  VehicleSimulationConfig config = exact();
  config.errors.localization.bias = 0.3;
  config.errors.localization.heading_bias = 0.005;
  config.errors.localization.yaw_rate_bias = 0.002;
  config.errors.chassis.speed_scale = 0.01;
  config.errors.markers.min_latency = config.errors.markers.max_latency = 0.1;
  VehicleSimulation vehicle = on_straight(config);
  vehicle.step(20.0);
  const Localization localization = vehicle.measure_localization();
  const Point2 error = localization.position.head<2>() - vehicle.map_from_base().position();
  EXPECT_GT(error.norm(), 0.01);
  EXPECT_LT(error.norm(), 1.5);
  EXPECT_NE(localization.heading, 0.0);
  EXPECT_LT(std::abs(localization.heading), 0.03);
  EXPECT_NE(localization.angular_velocity_body.z(), 0.0);
  EXPECT_LE(std::abs(localization.angular_velocity_body.z()), 0.002);
  const double scale = vehicle.measure_chassis().speed / vehicle.speed();
  EXPECT_NE(scale, 1.0);
  EXPECT_NEAR(scale, 1.0, 0.01);
  EXPECT_EQ(vehicle.marker_latency(), Duration::zero());
  vehicle.measure_lane_markers();
  EXPECT_EQ(vehicle.marker_latency(), std::chrono::milliseconds(100));
}

TEST(Manoeuvres, FaultsAreNamed) {
  VehicleSimulationConfig config = exact();
  config.lane_changes = {{100.0, 0.0, 3.5}};
  config.speed_changes = {{5.0, -100.0}};
  config.errors.localization.drift = -1.0;
  std::swap(config.paint.lines[0], config.paint.lines[1]);
  const std::vector<std::string> faults = config.validate();
  ASSERT_EQ(faults.size(), 4u);
  EXPECT_EQ(faults[0].find("lane change length is 0"), 0u);
  EXPECT_EQ(faults[1].find("speed change is -100"), 0u);
  EXPECT_EQ(faults[2], "the lines of paint do not lie from left to right");
  EXPECT_EQ(faults[3].find("errors/drift is -1"), 0u);
}

}  // namespace
}  // namespace relative_map::core
