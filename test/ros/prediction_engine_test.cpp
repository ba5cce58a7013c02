#include "relative_map/ros/prediction/prediction_engine.hpp"

#include <gmock/gmock.h>

#include <boost/make_shared.hpp>
#include <cmath>

#include "relative_map/prediction/prediction_check.hpp"
#include "relative_map/ros/prediction/prediction_markers.hpp"
#include "relative_map/ros/prediction/prediction_messages.hpp"

namespace relative_map {
namespace {

using testing::HasSubstr;

/// A vehicle that drives a circle, and what it sees of others, in its own moving frame.
class Drive : public testing::Test {
 protected:
  static constexpr double kSpeed = 10.0, kRadius = 100.0;

  explicit Drive(const PredictionNodeConfig& config = {})
      : engine_(config,
                [](const std::string& target, const std::string& source,
                   const ros::Time&) -> std::optional<Eigen::Isometry3d> {
                  if (target == source) return Eigen::Isometry3d::Identity();
                  if (source != "radar") return std::nullopt;
                  Eigen::Isometry3d base_from_radar = Eigen::Isometry3d::Identity();
                  base_from_radar.translate(Eigen::Vector3d(3.0, 0.0, 0.5));
                  return base_from_radar;
                }) {}

  static ros::Time time(double t) { return ros::Time(1000.0 + t); }
  static core::Pose2 pose(double t) {
    const double angle = kSpeed * t / kRadius;
    return {{5e5 + kRadius * std::sin(angle), 4e6 + kRadius * (1.0 - std::cos(angle))}, angle};
  }

  void localize(double t) {
    auto message = boost::make_shared<LocalizationEstimate>();
    message->header.stamp = time(t);
    message->header.frame_id = "map";
    const core::Pose2 place = pose(t);
    message->pose.position.x = place.position().x();
    message->pose.position.y = place.position().y();
    message->pose.orientation.z = std::sin(0.5 * place.heading());
    message->pose.orientation.w = std::cos(0.5 * place.heading());
    message->pose.heading = place.heading();
    message->pose.linear_velocity.x = kSpeed * std::cos(place.heading());
    message->pose.linear_velocity.y = kSpeed * std::sin(place.heading());
    message->pose.angular_velocity_vrf.z = message->pose.angular_velocity.z = kSpeed / kRadius;
    engine_.on_localization(message, time(t));
  }

  /// `places` in the map frame, relative to where the vehicle starts.
  void see(double t, const std::vector<core::Point2>& places, const std::string& frame = "base_link") {
    auto message = boost::make_shared<PerceptionObstacles>();
    message->header.stamp = time(t);
    message->header.frame_id = frame;
    for (std::size_t i = 0; i < places.size(); ++i) {
      PerceptionObstacle obstacle;
      obstacle.id = static_cast<int>(i);
      obstacle.type = PerceptionObstacle::VEHICLE;
      core::Point2 local = pose(t).to_local(places[i] + core::Point2(5e5, 4e6));
      if (frame == "map") local = places[i] + core::Point2(5e5, 4e6);
      if (frame == "radar") local.x() -= 3.0;
      obstacle.position.x = local.x();
      obstacle.position.y = local.y();
      obstacle.theta = frame == "map" ? 0.0 : -pose(t).heading();
      obstacle.length = 4.5;
      obstacle.width = 1.8;
      message->perception_obstacle.push_back(obstacle);
    }
    engine_.on_obstacles(message, time(t));
  }

  /// One car that drives east at 8 m/s, another that is parked.
  PredictionObstaclesPtr drive(double until, const std::string& frame = "base_link") {
    PredictionObstaclesPtr last;
    for (int i = 0; 0.1 * i <= until + 1e-9; ++i) {
      const double t = 0.1 * i;
      localize(t);
      see(t, {{30.0 + 8.0 * t, 20.0}, {20.0, -10.0}}, frame);
      if (const auto message = engine_.tick(time(t + 0.02))) last = message;
    }
    return last;
  }

  /// A straight lane under the moving car.
  void map(double t) {
    auto message = boost::make_shared<MapMsg>();
    message->header.stamp = time(t);
    message->header.frame_id = "base_link";
    Lane lane;
    lane.id = "road";
    lane.type = Lane::CITY_DRIVING;
    CurveSegment segment;
    for (double x = 0.0; x <= 250.0; x += 5.0) {
      const core::Point2 local = pose(t).to_local({5e5 + x, 4e6 + 20.0});
      geometry_msgs::Point point;
      point.x = local.x();
      point.y = local.y();
      segment.line_segment.point.push_back(point);
    }
    lane.central_curve.segment.push_back(segment);
    message->hdmap.lane.push_back(lane);
    message->current_lane_id = "road";
    engine_.on_map(message, time(t));
  }

  PredictionEngine engine_;
};

TEST_F(Drive, ARoadUserIsSeenOverGroundFromAMovingFrame) {
  for (const std::string frame : {"base_link", "radar", "map"}) {
    engine_.reset();
    const PredictionObstaclesPtr message = drive(2.0, frame);
    ASSERT_TRUE(message) << frame;
    EXPECT_EQ(message->header.frame_id, "base_link");
    EXPECT_EQ(message->header.stamp, time(2.0));
    ASSERT_EQ(message->prediction_obstacle.size(), 2u);
    // As published, frames that move made a parked car drive.
    EXPECT_TRUE(message->prediction_obstacle[1].is_static) << frame;
    const TrajectoryPoint& end = message->prediction_obstacle[0].trajectory[0].trajectory_point.back();
    const core::Point2 place = pose(2.0).to_parent({end.path_point.x, end.path_point.y});
    EXPECT_NEAR(place.x() - 5e5, 30.0 + 80.0, 2.0) << frame;
    EXPECT_NEAR(place.y() - 4e6, 20.0, 1.0) << frame;
    EXPECT_TRUE(core::check_prediction(to_core(*message)).empty());
  }
}

TEST_F(Drive, WithoutAMapEverybodyGoesStraightOnAndIsTold) {
  const PredictionObstaclesPtr message = drive(2.0);
  EXPECT_EQ(message->status.code, PredictionStatus::NO_MAP);
  EXPECT_EQ(message->prediction_obstacle[0].lane_id, "");
}

TEST_F(Drive, LanesAreThoseOfTheMapWhileItIsNew) {
  drive(2.0);
  localize(2.1);
  map(2.1);
  see(2.1, {{30.0 + 8.0 * 2.1, 20.0}});
  PredictionObstaclesPtr message = engine_.tick(time(2.12));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->status.code, PredictionStatus::OK) << message->status.message;
  EXPECT_EQ(message->prediction_obstacle[0].lane_id, "road");
  localize(3.5);
  see(3.5, {{30.0 + 8.0 * 3.5, 20.0}});
  message = engine_.tick(time(3.5));
  EXPECT_EQ(message->status.code, PredictionStatus::NO_MAP);
}

TEST_F(Drive, EveryFaultOfTheInputsHasAStatus) {
  EXPECT_EQ(engine_.tick(time(0.0))->status.code, PredictionStatus::NO_LOCALIZATION);
  localize(0.1);
  EXPECT_EQ(engine_.tick(time(0.1))->status.code, PredictionStatus::NO_OBSTACLES);
  see(0.1, {{30.0, 0.0}}, "lidar");
  PredictionObstaclesPtr message = engine_.tick(time(0.1));
  EXPECT_EQ(message->status.code, PredictionStatus::NO_TRANSFORM);
  EXPECT_THAT(message->status.message, HasSubstr("'lidar'"));
  engine_.reset();
  drive(1.0);
  localize(1.6);
  EXPECT_EQ(engine_.tick(time(1.6))->status.code, PredictionStatus::STALE_OBSTACLES);
  EXPECT_EQ(engine_.tick(time(2.5))->status.code, PredictionStatus::STALE_LOCALIZATION);
  auto broken = boost::make_shared<LocalizationEstimate>();
  broken->header.stamp = time(2.6);
  broken->pose.position.x = std::nan("");
  engine_.on_localization(broken, time(2.6));
  EXPECT_EQ(engine_.tick(time(2.6))->status.code, PredictionStatus::INVALID_LOCALIZATION);
}

TEST_F(Drive, ObstaclesAreAnsweredOnceAndWaitForTheirPose) {
  drive(1.0);
  EXPECT_FALSE(engine_.tick(time(1.05)));
  see(1.4, {{41.2, 20.0}});
  // The pose may be carried on to then, or still be to come.
  PredictionObstaclesPtr message = engine_.tick(time(1.4));
  localize(1.4);
  if (!message || message->header.stamp != time(1.4)) message = engine_.tick(time(1.42));
  ASSERT_TRUE(message);
  EXPECT_EQ(message->header.stamp, time(1.4));
}

TEST_F(Drive, TimeThatRunsBackForgetsAll) {
  drive(2.0);
  EXPECT_EQ(engine_.tick(time(0.5))->status.code, PredictionStatus::NO_LOCALIZATION);
}

TEST_F(Drive, UglyObstaclesCostASentence) {
  for (int i = 0; i <= 20; ++i) {
    const double t = 0.1 * i;
    localize(t);
    auto message = boost::make_shared<PerceptionObstacles>();
    message->header.stamp = time(t);
    for (int k = 0; k < 12; ++k) {
      PerceptionObstacle obstacle;
      obstacle.id = k % 10;
      obstacle.type = static_cast<std::uint8_t>(k * 30);
      obstacle.position.x = k == 3 ? std::nan("") : 10.0 * k + t;
      obstacle.position.y = k == 4 ? 1e300 : 5.0;
      obstacle.theta = k == 5 ? std::nan("") : 1e9;
      obstacle.velocity.x = k == 6 ? 1000.0 : std::nan("");
      obstacle.length = k == 7 ? -1.0 : 0.0;
      message->perception_obstacle.push_back(obstacle);
    }
    engine_.on_obstacles(message, time(t));
    const PredictionObstaclesPtr prediction = engine_.tick(time(t));
    ASSERT_TRUE(prediction);
    EXPECT_TRUE(core::check_prediction(to_core(*prediction)).empty());
    EXPECT_FALSE(engine_.remarks().empty());
  }
}

TEST_F(Drive, RibbonsAreAsOpaqueAsLikelyAndBoxesStandWhereTheyAre) {
  const PredictionObstaclesPtr message = drive(2.0);
  const visualization_msgs::MarkerArray markers = draw(*message);
  std::size_t boxes = 0, ribbons = 0;
  for (const visualization_msgs::Marker& marker : markers.markers) {
    if (marker.ns == "road users") {
      ++boxes;
      EXPECT_NEAR(marker.scale.x, 4.5, 1e-9);
    }
    if (marker.ns == "trajectories") {
      ++ribbons;
      EXPECT_EQ(marker.points.size() % 3, 0u);
      EXPECT_GT(marker.color.a, 0.0);
    }
  }
  EXPECT_EQ(boxes, 2u);
  EXPECT_GE(ribbons, 2u);
}

class MapFrame : public Drive {
 protected:
  static PredictionNodeConfig in_map_frame() {
    PredictionNodeConfig config;
    config.publish_in_map_frame = true;
    return config;
  }
  MapFrame() : Drive(in_map_frame()) {}
};

TEST_F(MapFrame, PredictionsAreThereIfTheyAreAskedFor) {
  const PredictionObstaclesPtr message = drive(2.0);
  EXPECT_EQ(message->header.frame_id, "map");
  EXPECT_NEAR(message->prediction_obstacle[1].perception_obstacle.position.x, 5e5 + 20.0, 0.1);
}

}  // namespace
}  // namespace relative_map
