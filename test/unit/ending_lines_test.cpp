#include <gmock/gmock.h>

#include "support/scene.hpp"

// Borders where a lane beside ends, where a recording turns about, and stamps after an empty map.
namespace relative_map::core {
namespace {

using test::arc;
using test::recording;
using test::Scene;
using test::straight;

void expect_widths_of_a_lane(const Lane& lane, const std::string& what) {
  for (const auto* samples : {&lane.left_samples, &lane.right_samples}) {
    for (const WidthSample& sample : *samples) {
      ASSERT_GT(sample.width, 0.5) << what << ", lane " << lane.id << " at s = " << sample.s;
      ASSERT_LT(sample.width, 2.6) << what << ", lane " << lane.id << " at s = " << sample.s;
    }
  }
  for (const LaneBoundary* border : {&lane.left_boundary, &lane.right_boundary}) {
    EXPECT_GT(border->length, 0.8 * lane.length) << what << ": it goes along the whole lane";
  }
}

TEST(EndingLines, LeaveTheLaneBesideItsBorder) {
  // A straight, then half a circle that leads back beside it; the other line ends on the straight.
  for (const double radius : {15.0, 40.0}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double end : {20.0, 49.5, 57.3}) {
        Polyline road = straight(Pose2(), 60.0, 0.5);
        const Polyline bend = arc(Pose2(Point2(60.0, 0.0), 0.0), side / radius, kPi * radius, 0.5);
        road.insert(road.end(), bend.begin() + 1, bend.end());
        const Pose2 back(Point2(60.0, 2.0 * side * radius), kPi);
        const Polyline home = straight(back, 60.0, 0.5);
        road.insert(road.end(), home.begin() + 1, home.end());
        const Polyline other = straight(Pose2(Point2(0.0, 3.5 * side), 0.0), end, 0.5);
        Scene scene({recording(road, "road", 0), recording(other, "other", 1)});
        const RelativeMap map = scene.at(Pose2(Point2(10.0, 0.0), 0.0));
        ASSERT_EQ(map.status.code, StatusCode::kOk);
        for (const Lane& lane : map.lanes) {
          expect_widths_of_a_lane(lane, std::to_string(radius) + ", " + std::to_string(side * end));
        }
        if (HasFatalFailure()) return;
      }
    }
  }
}

TEST(AboutTurns, EndTheLane) {
  for (const double kappa : {-5.0, 5.0, 3.0}) {
    Polyline points = straight(Pose2(), 100.0, 0.5);
    const Polyline turn = arc(Pose2(Point2(100.0, 0.0), 0.0), kappa, kPi / std::abs(kappa), 0.05);
    points.insert(points.end(), turn.begin() + 1, turn.end());
    const Polyline home = straight(Pose2(points.back(), kPi), 100.0, 0.5);
    points.insert(points.end(), home.begin() + 1, home.end());
    Scene scene({recording(points, "there and back", 0)});
    for (const double x : {10.0, 60.0, 95.0}) {
      const RelativeMap map = scene.at(Pose2(Point2(x, 0.0), 0.0));
      ASSERT_EQ(map.status.code, StatusCode::kOk);
      EXPECT_LT(map.lanes[0].length, 105.0) << "it ends where it turns about";
      expect_widths_of_a_lane(map.lanes[0], std::to_string(kappa));
    }
  }
}

TEST(Stamps, DoNotGoBackAfterAnEmptyMap) {
  Scene scene(test::three_straight_lines());
  const Pose2 pose(Point2(100.0, 0.0), 0.0);
  scene.at(pose);
  scene.wait(0.6);
  const RelativeMap empty = scene.tick();
  ASSERT_EQ(empty.status.code, StatusCode::kStaleLocalization);
  // A pose that is 2 ms older than the empty map.
  scene.pipeline().set_localization(
      test::localization_at(Pose2(Point2(106.0, 0.0), 0.0), scene.now() - from_seconds(0.002)));
  const RelativeMap map = scene.tick();
  ASSERT_EQ(map.status.code, StatusCode::kOk);
  EXPECT_GE(map.stamp, empty.stamp);
}

}  // namespace
}  // namespace relative_map::core
