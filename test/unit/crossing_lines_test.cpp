#include <gmock/gmock.h>

#include "support/scene.hpp"

// The lane that the car is in is never dropped, whatever lines cross it, run into it or lie on it.
namespace relative_map::core {
namespace {

using test::lane_about;
using test::lane_ids;
using test::recording;
using test::Scene;
using test::straight;
using testing::Contains;
using testing::Not;

constexpr double kDegree = kPi / 180.0;

/// The lane of the map that the vehicle is in runs where the vehicle does.
void expect_in_lane(const RelativeMap& map, const std::string& id, const std::string& what) {
  ASSERT_EQ(map.status.code, StatusCode::kOk) << what << ": " << map.status.message;
  ASSERT_EQ(map.current_lane_id, id) << what;
  const auto lane = std::find_if(map.lanes.begin(), map.lanes.end(),
                                 [&](const Lane& candidate) { return candidate.id == id; });
  ASSERT_NE(lane, map.lanes.end());
  const Foot foot = PolylineWalker(positions_of(lane->path)).next(Point2::Zero());
  EXPECT_LT(std::sqrt(foot.squared_distance), 1.0) << what;
}

/// A road along x and one that crosses it at (200, 0), `angle` aside, each with a priority of its own.
std::vector<RecordedLine> crossing(double angle, bool own_is_better, bool own_is_first, double spacing) {
  const Pose2 middle(Point2(200.0, 0.0), angle);
  const RecordedLine own = recording(straight(Pose2(), 500.0, spacing), "own", own_is_better ? 0 : 1);
  const RecordedLine other =
      recording(straight(middle.to_parent(Pose2(Point2(-150.0, 0.0), 0.0)), 300.0, spacing), "other",
                own_is_better ? 1 : 0);
  if (own_is_first) return {own, other};
  return {other, own};
}

TEST(CrossingLines, NeverTakeTheLaneAway) {
  for (const double degrees : {-80.0, -60.0, -45.0, -30.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 89.0}) {
    for (int variant = 0; variant < 8; ++variant) {
      const double spacing = variant & 4 ? 3.0 : 0.4;
      Scene scene(crossing(degrees * kDegree, variant & 1, variant & 2, spacing));
      for (double x = 150.0; x <= 250.0; x += 0.7) {
        const RelativeMap map = scene.at(Pose2(Point2(x, 0.0), 0.0));
        const std::string what = std::to_string(degrees) + " degrees, variant " + std::to_string(variant) +
                                 ", x = " + std::to_string(x);
        expect_in_lane(map, "own", what);
        for (const Lane& lane : map.lanes) {
          EXPECT_EQ(lane.left_neighbor_id + lane.right_neighbor_id, "") << what;
        }
        if (HasFailure()) return;
      }
    }
  }
}

TEST(CrossingLines, NeverTakeTheLaneAwayOnTheFirstMap) {
  for (const double degrees : {-70.0, -40.0, 30.0, 55.0, 80.0}) {
    for (double x = 190.0; x <= 210.0; x += 0.9) {
      for (const double aside : {-0.4, 0.0, 0.4}) {
        Scene scene(crossing(degrees * kDegree, false, true, 0.5));
        expect_in_lane(scene.at(Pose2(Point2(x, aside), 0.03)), "own", std::to_string(degrees));
      }
    }
  }
}

TEST(CrossingLines, AreFollowedByWhoTurnsIntoThem) {
  Scene scene(crossing(60.0 * kDegree, true, true, 0.5));
  scene.at(Pose2(Point2(199.0, 0.0), 0.0));
  const Pose2 on_other = Pose2(Point2(200.0, 0.0), 60.0 * kDegree).to_parent(Pose2(Point2(6.0, 0.3), 0.0));
  EXPECT_EQ(scene.at(on_other).current_lane_id, "other");
}

/// Onto the x axis at x = 300, from `side` * 12 m beside it, within `length` [m].
Polyline ramp(double side, double length, double spacing) {
  Polyline points;
  for (double x = 300.0 - length; x <= 500.0; x += spacing) {
    const double t = std::clamp((300.0 - x) / length, 0.0, 1.0);
    points.emplace_back(x, side * 12.0 * t * t * (3.0 - 2.0 * t));
  }
  return points;
}

TEST(Ramps, NeverTakeTheLaneAway) {
  for (const double length : {25.0, 60.0, 150.0}) {
    for (const double side : {-1.0, 1.0}) {
      for (const double spacing : {0.5, 4.0}) {
        for (const std::uint32_t priority : {0u, 2u}) {
          Scene scene({recording(straight(Pose2(), 500.0, spacing), "own", 1),
                       recording(ramp(side, length, spacing), "ramp", priority)});
          for (double x = 290.0 - length; x <= 400.0; x += 1.3) {
            expect_in_lane(
                scene.at(Pose2(Point2(x, 0.0), 0.0)), "own",
                std::to_string(length) + ", " + std::to_string(side) + ", x = " + std::to_string(x));
            if (HasFailure()) return;
          }
        }
      }
    }
  }
}

TEST(Ramps, AreLanesAsFarAsTheyRunBesideTheOtherOne) {
  Scene scene(
      {recording(straight(Pose2(), 500.0, 0.5), "own", 1), recording(ramp(1.0, 150.0, 0.5), "ramp", 0)});
  const RelativeMap map = scene.at(Pose2(Point2(170.0, 0.0), 0.0));
  ASSERT_EQ(lane_ids(map), std::vector<std::string>({"ramp", "own"}));
  EXPECT_LT(map.lanes[0].path.back().position.x(), 130.0) << "where they have become one";
}

/// Two recordings of one lane, `apart` [m].
std::vector<RecordedLine> recorded_twice(double apart, bool better_is_first) {
  std::vector<RecordedLine> lines = {
      recording(straight(Pose2(), 500.0, 0.5), "better", 0),
      recording(straight(Pose2(Point2(0.0, apart), 0.0), 500.0, 0.7), "worse", 1)};
  if (!better_is_first) std::swap(lines[0], lines[1]);
  return lines;
}

TEST(RecordedTwice, IsOneLaneTheOneThatIsFollowed) {
  for (const double apart : {-1.0, -0.7, -0.5, 0.35, 0.5, 0.8, 1.0}) {
    for (const bool first : {true, false}) {
      Scene scene(recorded_twice(apart, first));
      for (double x = 50.0; x <= 200.0; x += 1.0) {
        scene.see(lane_about({0.0}, 1.75, 60.0));  // the paint is beside the car
        const RelativeMap map = scene.at(Pose2(Point2(x, apart), 0.0));
        EXPECT_EQ(lane_ids(map), std::vector<std::string>({"worse"})) << apart;
        if (x < 60.0) continue;
        EXPECT_EQ(map.fusion.source, Source::kFused) << apart;
        EXPECT_NEAR(map.lanes[0].path[4].position.y(), 0.0, 0.1) << apart;
        if (HasFailure()) return;
      }
    }
  }
}

TEST(RecordedTwice, DoesNotChangeWithEveryTick) {
  for (const double apart : {0.3, 0.5, 1.0}) {
    Scene scene(recorded_twice(apart, true));
    std::string last;
    int changes = 0;
    for (double x = 50.0; x <= 200.0; x += 1.0) {  // the car sways by less than makes another one nearer
      const RelativeMap map = scene.at(Pose2(Point2(x, 0.5 * apart + 0.1 * std::sin(x)), 0.0));
      EXPECT_EQ(map.lanes.size(), 1u);
      changes += !last.empty() && map.current_lane_id != last;
      last = map.current_lane_id;
    }
    EXPECT_EQ(changes, 0) << apart;
  }
}

TEST(Source, IsFusedOnlyWhereTheLaneThatIsPublishedWas) {
  // The paint is seen beside one line; then the vehicle is on another, without any paint.
  Scene scene({recording(straight(Pose2(), 500.0, 0.5), "here", 0),
               recording(straight(Pose2(Point2(0.0, 9.0), 0.0), 500.0, 0.5), "there", 1)});
  for (double x = 50.0; x <= 60.0; x += 1.0) {
    scene.see(lane_about({0.3}, 1.75, 60.0));
    scene.at(Pose2(Point2(x, 0.0), 0.0));
  }
  EXPECT_EQ(scene.at(Pose2(Point2(61.0, 0.0), 0.0)).fusion.source, Source::kFused);
  const RelativeMap map = scene.at(Pose2(Point2(62.0, 9.0), 0.0));
  if (map.fusion.source == Source::kFused) {
    EXPECT_NE(map.fusion.lateral_offset.stddev, -1.0);
    EXPECT_NE(map.fusion.lateral_offset.value, 0.0);
  }
}

TEST(ManyLines, KeepTheOneThatTheVehicleIsOn) {
  for (const std::size_t own : {0u, 7u, 19u}) {
    std::vector<RecordedLine> lines;
    for (std::size_t i = 0; i < 20; ++i) {
      const std::uint32_t priority = i == own ? 30 : static_cast<std::uint32_t>(i);
      lines.push_back(recording(straight(Pose2(Point2(0.0, 1.4 * static_cast<double>(i)), 0.0), 300.0, 1.0),
                                "line " + std::to_string(i), priority));
    }
    PipelineConfig config;
    config.navigation_lane.max_distance_to_navigation_line = 50.0;
    Scene scene(lines, config);
    const Pose2 pose(Point2(100.0, 1.4 * static_cast<double>(own)), 0.0);
    expect_in_lane(scene.at(pose), "line " + std::to_string(own), "own = " + std::to_string(own));
  }
}

}  // namespace
}  // namespace relative_map::core
