// Standard messages in, this package's messages out, and its maps as paths.
#include <gmock/gmock.h>

#include <random>

#include "relative_map/ros/adapters/lane_paths.hpp"
#include "relative_map/ros/adapters/marker_fit.hpp"
#include "relative_map/ros/adapters/path_lines.hpp"
#include "relative_map/ros/adapters/standard_inputs.hpp"
#include "ros/moving_vehicle.hpp"

namespace relative_map {
namespace {

using test::kNaN;
using test::Point2;
using test::Pose2;
using test::quaternion;
using test::set_xyz;
using test::yaw;
using testing::ElementsAre;
using testing::HasSubstr;

nav_msgs::Odometry odometry_of(double heading, const Eigen::Vector3d& velocity, double yaw_rate) {
  nav_msgs::Odometry odometry;
  odometry.header.stamp = ros::Time(100.25);
  odometry.header.frame_id = "/odom";
  odometry.child_frame_id = "base_link";
  set_xyz(odometry.pose.pose.position, {10.0, -20.0, 3.0});
  odometry.pose.pose.orientation = quaternion(yaw(heading));
  set_xyz(odometry.twist.twist.linear, velocity);
  odometry.twist.twist.angular.z = yaw_rate;
  return odometry;
}

TEST(OdometryAdapter, TurnsTheChildsVelocityIntoTheMap) {
  for (const double heading : {0.0, 1.0, -2.5, 3.1}) {
    const LocalizationEstimate message = localization_from(odometry_of(heading, {12.0, 0.5, 0.0}, 0.2));
    EXPECT_EQ(message.header.stamp, ros::Time(100.25));
    EXPECT_EQ(message.header.frame_id, "odom");
    EXPECT_EQ(message.child_frame_id, "base_link");
    EXPECT_EQ(message.pose.position.y, -20.0);
    EXPECT_TRUE(std::isnan(message.pose.heading)) << "the orientation's";
    EXPECT_NEAR(message.pose.linear_velocity.x, 12.0 * std::cos(heading) - 0.5 * std::sin(heading), 1e-12);
    EXPECT_NEAR(message.pose.linear_velocity.y, 12.0 * std::sin(heading) + 0.5 * std::cos(heading), 1e-12);
    EXPECT_DOUBLE_EQ(message.pose.angular_velocity_vrf.z, 0.2);
    EXPECT_NEAR(message.pose.euler_angles.z, heading, 1e-12);
    EXPECT_TRUE(std::isnan(message.pose.linear_acceleration.x));
  }
}

TEST(OdometryAdapter, MakesStandardDeviationsOfVariances) {
  nav_msgs::Odometry odometry = odometry_of(core::kPi / 2.0, {5.0, 0.0, 0.0}, 0.0);
  odometry.pose.covariance[0] = 0.04;
  odometry.pose.covariance[7] = 0.09;
  odometry.pose.covariance[14] = -1.0;  // not known
  odometry.pose.covariance[35] = 1e-4;
  odometry.twist.covariance[0] = 0.25;  // along the vehicle, which is north
  odometry.twist.covariance[7] = 0.01;
  odometry.twist.covariance[35] = 1e-6;
  const Uncertainty uncertainty = localization_from(odometry).uncertainty;
  EXPECT_DOUBLE_EQ(uncertainty.position_std_dev.x, 0.2);
  EXPECT_DOUBLE_EQ(uncertainty.position_std_dev.y, 0.3);
  EXPECT_TRUE(std::isnan(uncertainty.position_std_dev.z));
  EXPECT_TRUE(std::isnan(uncertainty.orientation_std_dev.x)) << "0 is not given";
  EXPECT_DOUBLE_EQ(uncertainty.orientation_std_dev.z, 0.01);
  EXPECT_NEAR(uncertainty.linear_velocity_std_dev.x, 0.1, 1e-12);
  EXPECT_NEAR(uncertainty.linear_velocity_std_dev.y, 0.5, 1e-12);
  EXPECT_DOUBLE_EQ(uncertainty.angular_velocity_std_dev.z, 1e-3);
}

TEST(OdometryAdapter, GivesTheMapOfTheSamePose) {
  const test::Drive drive;
  test::Engine direct, adapted;
  const NavigationInfo lines = test::three_lanes(drive.pose.to_parent(Pose2(Point2(-20.0, 0.4), 0.02)));
  direct.set_lines(lines);
  adapted.set_lines(lines);
  direct->on_localization(
      test::shared(test::localization_of_link(drive, Eigen::Isometry3d::Identity(), "base_link")),
      test::kStamp);
  nav_msgs::Odometry odometry = odometry_of(drive.pose.heading(), {drive.speed, 0.0, 0.0}, drive.yaw_rate);
  odometry.header.stamp = test::kStamp;
  odometry.header.frame_id = "map";
  set_xyz(odometry.pose.pose.position, {drive.pose.position().x(), drive.pose.position().y(), 20.0});
  adapted->on_localization(test::shared(localization_from(odometry)), test::kStamp);
  test::expect_same_lanes(adapted.map_at(test::kStamp), direct.map_at(test::kStamp), 3, 1e-8);
}

TEST(OdometryAdapter, PassesNonsenseOnForTheMapToRefuse) {
  nav_msgs::Odometry odometry = odometry_of(0.0, {5.0, 0.0, 0.0}, 0.0);
  odometry.pose.pose.orientation = geometry_msgs::Quaternion();
  const LocalizationEstimate message = localization_from(odometry);
  EXPECT_TRUE(std::isnan(message.pose.linear_velocity.x)) << "no direction";
  EXPECT_EQ(message.pose.orientation.w, 0.0);
}

TEST(TransformAdapter, TellsThePoseAndNoVelocity) {
  geometry_msgs::TransformStamped transform;
  transform.header.stamp = ros::Time(7.0);
  transform.header.frame_id = "map";
  transform.child_frame_id = "car1/base_link";
  set_xyz(transform.transform.translation, {1.0, 2.0, 3.0});
  transform.transform.rotation = quaternion(yaw(0.7));
  const LocalizationEstimate message = localization_from(transform);
  EXPECT_EQ(message.child_frame_id, "car1/base_link");
  EXPECT_EQ(message.pose.position.z, 3.0);
  EXPECT_NEAR(message.pose.euler_angles.z, 0.7, 1e-12);
  EXPECT_TRUE(std::isnan(message.pose.linear_velocity.x));
  EXPECT_TRUE(std::isnan(message.pose.angular_velocity_vrf.z));
}

geometry_msgs::TwistStamped twist_of(double x, const std::string& frame = "base_link") {
  geometry_msgs::TwistStamped twist;
  twist.header.stamp = ros::Time(5.0);
  twist.header.frame_id = frame;
  twist.twist.linear.x = x;
  return twist;
}

LinkTransforms no_links() {
  return [](const std::string&, const std::string&, const ros::Time&) { return std::nullopt; };
}

TEST(TwistAdapter, TellsTheGearByTheSign) {
  ChassisFromTwist adapter("base_link", no_links());
  const auto gear = [&](double speed) { return adapter.convert(twist_of(speed))->gear_location; };
  EXPECT_EQ(gear(10.0), Chassis::GEAR_DRIVE);
  EXPECT_EQ(gear(0.0), Chassis::GEAR_DRIVE);
  EXPECT_EQ(gear(-0.02), Chassis::GEAR_DRIVE) << "noise while it stands";
  EXPECT_EQ(gear(-1.0), Chassis::GEAR_REVERSE);
  EXPECT_EQ(gear(0.01), Chassis::GEAR_REVERSE) << "it stands, and goes on as it went";
  EXPECT_EQ(gear(1.0), Chassis::GEAR_DRIVE);
  EXPECT_DOUBLE_EQ(adapter.convert(twist_of(-3.0))->speed_mps, 3.0);
  EXPECT_EQ(to_core(*adapter.convert(twist_of(-3.0)), ros::Time()).speed, -3.0);
}

TEST(TwistAdapter, ReadsBothKindsAndAnEmptyFrame) {
  ChassisFromTwist adapter("base_link", no_links());
  geometry_msgs::TwistWithCovarianceStamped twist;
  twist.header.stamp = ros::Time(5.0);
  twist.twist.twist.linear.x = 8.0;
  ASSERT_TRUE(adapter.convert(twist));
  EXPECT_DOUBLE_EQ(adapter.convert(twist)->speed_mps, 8.0);
  EXPECT_EQ(adapter.convert(twist)->header.stamp, ros::Time(5.0));
}

/// A sensor that looks back, 2 m ahead of the axle and 1 m to its left, on a car that drives and turns.
TEST(TwistAdapter, CarriesTheTwistOfAnotherLinkToTheBase) {
  ChassisFromTwist adapter("base_link", [](const std::string&, const std::string&, const ros::Time&) {
    Eigen::Isometry3d base_from_link = Eigen::Isometry3d::Identity();
    base_from_link.translate(Eigen::Vector3d(2.0, 1.0, 0.0));
    base_from_link.rotate(yaw(core::kPi));
    return std::optional<Eigen::Isometry3d>(base_from_link);
  });
  geometry_msgs::TwistStamped twist = twist_of(0.0, "radar");
  const double speed = 10.0, yaw_rate = 0.3;
  twist.twist.linear.x = -(speed - yaw_rate * 1.0);
  twist.twist.linear.y = -(yaw_rate * 2.0);
  twist.twist.angular.z = yaw_rate;
  const auto chassis = adapter.convert(twist);
  ASSERT_TRUE(chassis);
  EXPECT_NEAR(chassis->speed_mps, speed, 1e-9);
  EXPECT_EQ(chassis->gear_location, Chassis::GEAR_DRIVE);
  EXPECT_EQ(chassis->header.frame_id, "base_link");
  EXPECT_FALSE(ChassisFromTwist("base_link", no_links()).convert(twist));
}

nav_msgs::Path path_of(const core::Polyline& points, const std::string& frame = "map") {
  nav_msgs::Path path;
  path.header.stamp = ros::Time(1.0);
  path.header.frame_id = frame;
  for (const Point2& point : points) {
    geometry_msgs::PoseStamped pose;
    set_xyz(pose.pose.position, {point.x(), point.y(), 0.0});
    path.poses.push_back(pose);
  }
  return path;
}

std::vector<std::string> names_of(const NavigationInfo& info) {
  std::vector<std::string> names;
  for (const NavigationPath& line : info.navigation_path) names.push_back(line.path.name);
  return names;
}

TEST(PathAdapter, MakesLinesInTheOrderOfTheirTopics) {
  PathLines lines({"middle", "left"});
  const auto first = lines.add("left", path_of({{0.0, 3.5}, {10.0, 3.5}}));
  ASSERT_TRUE(first.lines);
  EXPECT_THAT(names_of(*first.lines), ElementsAre("left"));
  const auto second = lines.add("middle", path_of({{0.0, 0.0}, {10.0, 0.0}}, "/map"));
  ASSERT_TRUE(second.lines);
  EXPECT_THAT(names_of(*second.lines), ElementsAre("middle", "left"));
  EXPECT_EQ(second.lines->header.frame_id, "map");
  EXPECT_EQ(second.lines->navigation_path[0].path_priority, 0u);
  EXPECT_EQ(second.lines->navigation_path[1].path_priority, 1u);
  EXPECT_EQ(second.lines->navigation_path[1].path.path_point[1].x, 10.0);
  EXPECT_TRUE(std::isnan(second.lines->navigation_path[0].path.path_point[0].theta));
}

TEST(PathAdapter, TellsOfAPathOnceHoweverOftenItComes) {
  PathLines lines({"path"});
  nav_msgs::Path path = path_of({{0.0, 0.0}, {10.0, 0.0}});
  EXPECT_TRUE(lines.add("path", path).lines);
  path.header.stamp += ros::Duration(1.0);
  EXPECT_FALSE(lines.add("path", path).lines);
  path.poses[1].pose.position.y = 0.5;
  EXPECT_TRUE(lines.add("path", path).lines);
}

TEST(PathAdapter, TakesALineAwayWhosePathIsEmpty) {
  PathLines lines({"a", "b"});
  lines.add("a", path_of({{0.0, 0.0}, {10.0, 0.0}}));
  lines.add("b", path_of({{0.0, 3.5}, {10.0, 3.5}}));
  const auto answer = lines.add("a", path_of({}));
  ASSERT_TRUE(answer.lines);
  EXPECT_THAT(names_of(*answer.lines), ElementsAre("b"));
  EXPECT_FALSE(lines.add("a", path_of({})).lines);
}

TEST(PathAdapter, RefusesAPathOfAnotherFrame) {
  PathLines lines({"a", "b"});
  lines.add("a", path_of({{0.0, 0.0}, {10.0, 0.0}}));
  const auto answer = lines.add("b", path_of({{0.0, 3.5}, {10.0, 3.5}}, "odom"));
  EXPECT_FALSE(answer.lines);
  EXPECT_THAT(answer.fault, HasSubstr("b: is in frame 'odom', but a in 'map'"));
}

/// Points of paint a step [m] apart; noise [m] in y.
nav_msgs::Path paint(const core::Cubic& cubic, double from, double to, double step, double noise = 0.0,
                     unsigned seed = 1) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal(0.0, 1.0);
  core::Polyline points;
  for (double x = from; x <= to; x += step) {
    const double y = cubic.c0 + x * (cubic.c1 + x * (cubic.c2 + x * cubic.c3));
    points.emplace_back(x, y + noise * normal(random));
  }
  nav_msgs::Path path = path_of(points, "camera");
  path.header.stamp = ros::Time(50.0);
  return path;
}

const core::Cubic kBend{1.75, 0.02, 0.001, -4e-6};

TEST(MarkerFit, FindsTheCubicThatThePointsLieOn) {
  for (const double step : {0.5, 2.0, 7.0}) {
    const FittedMarker fitted = fit_marker(paint(kBend, 1.0, 80.0, step), 0.1);
    EXPECT_EQ(fitted.fault, "");
    EXPECT_NEAR(fitted.marker.c0_position, kBend.c0, 1e-9) << step;
    EXPECT_NEAR(fitted.marker.c1_heading_angle, kBend.c1, 1e-10);
    EXPECT_NEAR(fitted.marker.c2_curvature, kBend.c2, 1e-11);
    EXPECT_NEAR(fitted.marker.c3_curvature_derivative, kBend.c3, 1e-12);
    EXPECT_NEAR(fitted.residual, 0.0, 1e-9);
    EXPECT_EQ(fitted.marker.longitude_start, 1.0);
    EXPECT_GT(fitted.marker.view_range, 80.0 - step - 1e-9);
    EXPECT_EQ(fitted.marker.quality, 1.0);
  }
}

TEST(MarkerFit, TellsTheNoiseOfThePointsAsItsResidual) {
  for (unsigned seed = 1; seed <= 5; ++seed) {
    const FittedMarker fitted = fit_marker(paint(kBend, 0.0, 60.0, 0.2, 0.05, seed), 0.2);
    EXPECT_NEAR(fitted.residual, 0.05, 0.01) << seed;
    EXPECT_NEAR(fitted.marker.c0_position, kBend.c0, 0.06);
  }
}

TEST(MarkerFit, LeavesTheFarEndOutWhereNoCubicReaches) {
  core::Polyline points;  // straight, then round a corner of 15 m
  for (double s = 0.0; s <= 60.0; s += 1.0) {
    const double turned = std::max(0.0, s - 40.0) / 15.0;
    points.emplace_back(std::min(s, 40.0) + 15.0 * std::sin(turned), 1.5 + 15.0 * (1.0 - std::cos(turned)));
  }
  const FittedMarker fitted = fit_marker(path_of(points, "camera"), 0.1);
  EXPECT_EQ(fitted.fault, "");
  EXPECT_LE(fitted.residual, 0.1);
  EXPECT_GT(fitted.left_out, 1.0);
  EXPECT_GT(fitted.marker.view_range, 30.0);
  EXPECT_NEAR(fitted.marker.c0_position, 1.5, 0.2);
}

TEST(MarkerFit, RefusesWhatIsNoLine) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> anywhere(-3.0, 3.0);
  core::Polyline points;
  for (double x = 0.0; x < 50.0; x += 1.0) points.emplace_back(x, anywhere(random));
  EXPECT_THAT(fit_marker(path_of(points), 0.1).fault, HasSubstr("no cubic fits"));
  EXPECT_EQ(fit_marker(path_of(points), 0.1).marker.quality, 0.0);
  EXPECT_THAT(fit_marker(path_of({}), 0.1).fault, HasSubstr("points ahead"));
  EXPECT_THAT(fit_marker(path_of({{-20.0, 1.0}, {-5.0, 1.0}}), 0.1).fault, HasSubstr("points ahead"));
  EXPECT_THAT(fit_marker(path_of({{1.0, kNaN}, {2.0, 1.0}}), 0.1).fault, HasSubstr("points ahead"));
}

TEST(MarkerFit, OfFewPointsIsOfLowDegree) {
  const FittedMarker two = fit_marker(path_of({{0.0, 1.0}, {20.0, 2.0}}), 0.1);
  EXPECT_EQ(two.marker.model_degree, 1);
  EXPECT_NEAR(two.marker.c1_heading_angle, 0.05, 1e-12);
  EXPECT_EQ(two.marker.c2_curvature, 0.0);
}

TEST(MarkerPairing, PutsBothSidesOfAnImageTogether) {
  MarkerPairing pairing(0.1);
  nav_msgs::Path left = paint({1.75, 0.0, 0.0, 0.0}, 0.0, 50.0, 1.0),
                 right = paint({-1.75, 0.0, 0.0, 0.0}, 0.0, 50.0, 1.0);
  std::size_t images = 0;
  for (int i = 0; i < 20; ++i) {
    left.header.stamp = right.header.stamp = ros::Time(50.0 + 0.1 * i);
    const ros::Time received = left.header.stamp + ros::Duration(0.05);
    const bool left_first = i % 3 != 0;  // they overtake each other
    for (const bool is_left : {left_first, !left_first}) {
      const auto answer = pairing.add(is_left, is_left ? left : right, received);
      if (!answer.markers) continue;
      ++images;
      if (answer.markers->header.stamp == ros::Time(50.0)) continue;  // the other side was not known of yet
      EXPECT_EQ(answer.markers->header.stamp, left.header.stamp);
      EXPECT_NEAR(answer.markers->left_lane_marker.c0_position, 1.75, 1e-9);
      EXPECT_NEAR(answer.markers->right_lane_marker.c0_position, -1.75, 1e-9);
      EXPECT_EQ(answer.markers->header.frame_id, "camera");
    }
  }
  EXPECT_GE(images, 19u);
}

TEST(MarkerPairing, SendsASideAloneWhoseOtherOneIsNotSeen) {
  MarkerPairing pairing(0.1);
  nav_msgs::Path left = paint({1.75, 0.0, 0.0, 0.0}, 0.0, 50.0, 1.0);
  std::size_t images = 0;
  for (int i = 0; i < 20; ++i) {
    left.header.stamp = ros::Time(50.0 + 0.1 * i);
    const auto answer = pairing.add(true, left, left.header.stamp);
    if (!answer.markers) continue;
    ++images;
    EXPECT_EQ(answer.markers->right_lane_marker.quality, 0.0);
    EXPECT_EQ(answer.markers->left_lane_marker.quality, 1.0);
  }
  EXPECT_EQ(images, 20u);
}

TEST(LanePaths, AreNamedByTheirPlaceBesideTheVehicle) {
  test::Engine engine;
  engine.set_lines(test::three_lanes(Pose2()));
  engine.drive_to(Pose2({50.0, 0.2}, 0.0), ros::Time(10.0));
  const MapMsg map = engine.map_at(ros::Time(10.0));
  const auto paths = lane_paths(map);
  ASSERT_EQ(paths.size(), 9u);
  for (const char* name : {"current/centerline", "left_1/left_border", "right_1/right_border"}) {
    ASSERT_EQ(paths.count(name), 1u) << name;
    EXPECT_EQ(paths.at(name).header.stamp, map.header.stamp);
    EXPECT_EQ(paths.at(name).header.frame_id, "base_link");
    EXPECT_GT(paths.at(name).poses.size(), 50u);
  }
  const auto y_of = [&](const char* name) { return paths.at(name).poses[5].pose.position.y; };
  EXPECT_NEAR(y_of("current/centerline"), -0.2, 1e-6);
  EXPECT_NEAR(y_of("left_1/centerline"), 3.3, 1e-6);
  EXPECT_NEAR(y_of("current/left_border"), 1.55, 1e-6);
  EXPECT_NEAR(y_of("left_1/right_border"), 1.55, 1e-6);
  EXPECT_NEAR(y_of("right_1/right_border"), -5.45, 0.3);
}

TEST(LanePaths, OfAnEmptyMapAreNone) {
  EXPECT_TRUE(lane_paths(MapMsg()).empty());
}

}  // namespace
}  // namespace relative_map
