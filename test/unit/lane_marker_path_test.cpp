#include "relative_map/pipeline/fixed_weight/lane_marker_path.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/lines.hpp"
#include "support/markers.hpp"

namespace relative_map::core {
namespace {

using test::kNaN;
using test::lane_about;
using test::marker;
using testing::HasSubstr;

constexpr double kSpeed = 20.0;  // [m/s], times 8 s: a path of 160 m

MarkerPath path_of(const LaneMarkers& markers, const Pose2& base_from_sensor = Pose2(),
                   double speed = kSpeed) {
  const auto made = make_marker_path(markers, base_from_sensor, speed, MapParam(), NavigationLaneParam());
  if (const auto* reason = std::get_if<std::string>(&made)) {
    ADD_FAILURE() << *reason;
    return {};
  }
  return std::get<MarkerPath>(made);
}

std::string refusal_of(const LaneMarkers& markers) {
  const auto made = make_marker_path(markers, Pose2(), kSpeed, MapParam(), NavigationLaneParam());
  const auto* reason = std::get_if<std::string>(&made);
  return reason != nullptr ? *reason : "accepted";
}

TEST(MarkerPath, IsTheMeanOfBothCubicsWithTheBetterOneWeighingMore) {
  LaneMarkers markers;
  markers.left = marker({1.8, 0.01, 4e-4, 1e-6}, 60.0, 0.6);
  markers.right = marker({-1.6, 0.04, 1e-4, 5e-6}, 60.0, 0.9);
  const MarkerPath path = path_of(markers);
  const Cubic mean{0.1, 0.4 * 0.01 + 0.6 * 0.04, 0.4 * 4e-4 + 0.6 * 1e-4, 0.4 * 1e-6 + 0.6 * 5e-6};
  ASSERT_GT(path.path.points.size(), 62u);
  for (std::size_t i = 0; i <= 62; ++i) {
    const double x = static_cast<double>(i) - 2.0;
    const PathPoint& point = path.path.points[i];
    EXPECT_EQ(point.position.x(), x) << "sampled at x = -2, -1, 0 ...";
    EXPECT_NEAR(point.position.y(), mean.value(x), 1e-12);
    EXPECT_NEAR(point.theta, std::atan(mean.slope(x)), 1e-12);
    EXPECT_NEAR(point.kappa, mean.kappa(x), 1e-12);
  }
}

TEST(MarkerPath, HasArcLengthFromZeroAndTheRateOfItsCurvature) {
  const MarkerPath path = path_of(lane_about({0.2, 0.02, 4e-4, 1e-6}));
  EXPECT_EQ(path.path.points.front().s, 0.0);
  for (std::size_t i = 1; i + 1 < path.path.points.size(); ++i) {
    const PathPoint &a = path.path.points[i - 1], &b = path.path.points[i], &c = path.path.points[i + 1];
    EXPECT_NEAR(b.s - a.s, (b.position - a.position).norm(), 1e-12);
    EXPECT_NEAR(b.dkappa, (c.kappa - a.kappa) / (c.s - a.s), 1e-12);
  }
}

TEST(MarkerPath, IsAsLongAsTheSpeedAsksFor) {
  for (const auto& [speed, length] : std::vector<std::pair<double, double>>{
           {0.0, 150.0}, {18.0, 150.0}, {20.0, 160.0}, {25.0, 200.0}, {40.0, 250.0}, {-25.0, 200.0}}) {
    const MarkerPath path = path_of(lane_about({}), Pose2(), speed);
    EXPECT_NEAR(path.path.points.back().position.x(), length, 1e-9) << speed << " m/s";
    EXPECT_NEAR(path.path.remaining, length, 1e-9);
  }
}

TEST(MarkerPath, IsTrustedWherePaintWasSeen) {
  LaneMarkers markers = lane_about({0.3});
  markers.left.longitude_start = 4.5;
  markers.right.longitude_start = 1.0;
  markers.left.view_range = 70.0;
  markers.right.view_range = 40.5;
  const MarkerPath path = path_of(markers);
  EXPECT_NEAR(path.trusted_from, 2.0 + 5.0, 1e-12) << "where both are seen";
  EXPECT_NEAR(path.trusted_to, 2.0 + 40.0, 1e-12);
}

TEST(MarkerPath, PastItsViewRangeUnwindsToAStraight) {
  const MarkerPath path = path_of(lane_about({0.0, 0.0, 1e-3, 0.0}, 1.75, 50.0));
  const PathPoints& points = path.path.points;
  const double kappa_at_end = points[52].kappa;
  EXPECT_NEAR(kappa_at_end, Cubic({0.0, 0.0, 1e-3, 0.0}).kappa(50.0), 1e-12);
  for (std::size_t i = 53; i < points.size(); ++i) {
    EXPECT_LE(points[i].kappa, points[i - 1].kappa + 1e-15);
    EXPECT_GE(points[i].kappa, 0.0);
    EXPECT_NEAR(angle_difference(points[i].theta, points[i - 1].theta),
                0.5 * (points[i].kappa + points[i - 1].kappa), 1e-4)
        << "it turns by its curvature";
    EXPECT_NEAR((points[i].position - points[i - 1].position).norm(), 1.0, 1e-9);
  }
  EXPECT_EQ(points.back().kappa, 0.0);
}

TEST(MarkerPath, NeverBelievesACubicPastItsViewRange) {
  // Fine up to 20 m, and 29 m to the left at 100 m.
  const MarkerPath path = path_of(lane_about({0.0, 0.0, 0.0, 3e-5}, 1.75, 20.0));
  EXPECT_LT(path.path.points[102].position.y(), 9.0);
}

TEST(MarkerPath, BesideOneMarkerRunsAtTheDefaultHalfWidth) {
  const Cubic paint{1.7, 0.02, 1e-3, 2e-6};
  LaneMarkers left;
  left.left = marker(paint);
  const MarkerPath path = path_of(left);
  for (std::size_t i = 0; i <= 52; ++i) {
    const double x = static_cast<double>(i) - 2.0, theta = std::atan(paint.slope(x));
    const Point2 expected = Point2(x, paint.value(x)) - 1.75 * Point2(-std::sin(theta), std::cos(theta));
    EXPECT_NEAR((path.path.points[i].position - expected).norm(), 0.0, 1e-12) << "square to the paint";
    EXPECT_NEAR(1.0 / path.path.points[i].kappa, 1.0 / paint.kappa(x) + 1.75, 1e-6) << "a wider curve";
  }
  EXPECT_EQ(path.path.left_half_width, 1.75);
  EXPECT_EQ(path.path.right_half_width, 1.75);
  EXPECT_TRUE(path.left_paint);
  EXPECT_FALSE(path.right_paint);
}

TEST(MarkerPath, TakesNoCountOfAMarkerOfPoorQuality) {
  LaneMarkers markers = lane_about({0.0});
  markers.left.cubic.c0 = 9.0;
  markers.left.quality = 0.49;
  const MarkerPath path = path_of(markers);
  EXPECT_NEAR(path.path.points[0].position.y(), 0.0, 1e-12) << "1.75 m left of the right one";
  EXPECT_FALSE(path.left_paint);
  markers.right.quality = 0.49;
  EXPECT_THAT(refusal_of(markers), HasSubstr("left: quality is 0.49; right: quality is 0.49"));
}

TEST(MarkerPath, TakesNoCountOfAMarkerThatIsNotSeen) {
  EXPECT_THAT(refusal_of(LaneMarkers()), HasSubstr("left: quality is 0;")) << "all zeros is no marker";
  NavigationLaneParam any_quality;
  any_quality.min_lane_marker_quality = 0.0;
  const auto made = make_marker_path(LaneMarkers(), Pose2(), kSpeed, MapParam(), any_quality);
  EXPECT_TRUE(std::holds_alternative<std::string>(made)) << "whatever quality is asked for";
}

TEST(MarkerPath, TakesNoCountOfAMarkerThatIsSeenTooShort) {
  LaneMarkers markers = lane_about({0.0}, 1.75, 0.4);
  EXPECT_THAT(refusal_of(markers), HasSubstr("left: view_range is 0.4 m"));
  markers.left.view_range = markers.right.view_range = 0.6;
  EXPECT_EQ(refusal_of(markers), "accepted");
  markers.left.longitude_start = markers.right.longitude_start = 0.7;
  EXPECT_THAT(refusal_of(markers), HasSubstr("longitude_start is 0.7 m")) << "past its end";
  markers.left.view_range = -5.0;
  EXPECT_THAT(refusal_of(markers), HasSubstr("left: view_range is -5 m"));
}

TEST(MarkerPath, TakesNoCountOfNumbersThatAreNotFinite) {
  const auto with = [](auto change) {
    LaneMarkers markers = lane_about({0.0});
    markers.right.quality = 0.0;
    change(markers.left);
    return refusal_of(markers);
  };
  EXPECT_EQ(with([](LaneMarker&) {}), "accepted");
  EXPECT_THAT(with([](LaneMarker& left) { left.quality = kNaN; }), HasSubstr("left: quality is nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.cubic.c0 = kNaN; }),
              HasSubstr("left: no vehicle could follow c0..c3 = nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.cubic.c1 = kNaN; }),
              HasSubstr("left: no vehicle could follow c0..c3 = 1.75, nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.cubic.c2 = kNaN; }),
              HasSubstr("left: no vehicle could follow c0..c3 = 1.75, 0, nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.cubic.c3 = kNaN; }),
              HasSubstr("left: no vehicle could follow c0..c3 = 1.75, 0, 0, nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.view_range = kNaN; }), HasSubstr("left: view_range is nan"));
  EXPECT_THAT(with([](LaneMarker& left) { left.longitude_start = kNaN; }),
              HasSubstr("left: longitude_start is nan"));
}

TEST(MarkerPath, TakesNoCountOfPaintThatNoVehicleCanFollow) {
  LaneMarkers markers;
  markers.left = marker({1.75, 0.0, -0.3, 0.0});  // a radius of 1.7 m
  EXPECT_THAT(refusal_of(markers), HasSubstr("left: no vehicle could follow c0..c3 = 1.75, 0, -0.3, 0"));
}

TEST(MarkerPath, IsRefusedWhereBothMarkersMakeNoLane) {
  EXPECT_THAT(refusal_of(lane_about({0.0}, 0.3)), HasSubstr("0.6 m apart"));
  EXPECT_THAT(refusal_of(lane_about({0.0}, 4.0)), HasSubstr("8 m apart"));
  EXPECT_THAT(refusal_of(lane_about({0.0}, -1.75)), HasSubstr("-3.5 m apart")) << "left and right swapped";
}

TEST(MarkerPath, HasThePerceivedHalfWidthsWithinTheirLimits) {
  EXPECT_NEAR(path_of(lane_about({0.4}, 1.6)).path.left_half_width, 1.6, 1e-12);
  EXPECT_NEAR(path_of(lane_about({0.4}, 1.6)).path.right_half_width, 1.6, 1e-12) << "from the lane's center";
  EXPECT_EQ(path_of(lane_about({0.0}, 1.2)).path.left_half_width, 1.5);
  EXPECT_EQ(path_of(lane_about({0.0}, 2.4)).path.left_half_width, 2.0);
  const double skewed = path_of(lane_about({0.0, 0.5}, 1.9)).path.left_half_width;
  EXPECT_NEAR(skewed, 1.9 * std::cos(std::atan(0.5)), 1e-12) << "square to the lane";
}

TEST(MarkerPath, OfMirroredMarkersIsMirrored) {
  LaneMarkers markers = lane_about({0.3, 0.02, -6e-4, 4e-6}, 1.6, 45.0);
  markers.left.quality = 0.7;
  markers.right.cubic.c2 = 1e-4;
  const MarkerPath path = path_of(markers), mirrored = path_of(test::mirrored(markers));
  ASSERT_EQ(path.path.points.size(), mirrored.path.points.size());
  for (std::size_t i = 0; i < path.path.points.size(); ++i) {
    const PathPoint &a = path.path.points[i], &b = mirrored.path.points[i];
    EXPECT_NEAR(a.position.x(), b.position.x(), 1e-9);
    EXPECT_NEAR(a.position.y(), -b.position.y(), 1e-9);
    EXPECT_NEAR(a.theta, -b.theta, 1e-12);
    EXPECT_NEAR(a.kappa, -b.kappa, 1e-12);
  }
  EXPECT_NEAR(path.path.l, -mirrored.path.l, 1e-12);
}

TEST(MarkerPath, KnowsWhereTheVehicleIs) {
  const MarkerPath path = path_of(lane_about({0.6, 0.0}));
  EXPECT_NEAR(path.path.s_at_vehicle, 2.0, 1e-12);
  EXPECT_NEAR(path.path.l, -0.6, 1e-12) << "right of the path";
}

TEST(MarkerPath, SeenAMomentAgoIsCarriedToWhereTheVehicleIsNow) {
  // Paint on a circle of 500 m radius, seen before the vehicle drove 3 m and turned.
  const double kappa = 1.0 / 500.0;
  const LaneMarkers markers = lane_about({0.4, 0.0, kappa / 2.0, 0.0}, 1.75, 30.0);
  const Pose2 seen_from(Point2(700.0, 300.0), 2.9);
  const Pose2 now = seen_from.to_parent(Pose2(Point2(3.0, 0.2), 0.05));
  const MarkerPath path = path_of(markers, now.to_local(seen_from));
  const Point2 center = seen_from.to_parent(Point2(0.0, 0.4 + 500.0));
  std::size_t trusted = 0;
  for (const PathPoint& point : path.path.points) {
    if (point.s < path.trusted_from || point.s > path.trusted_to) continue;
    ++trusted;
    EXPECT_NEAR((now.to_parent(point.position) - center).norm(), 500.0, 1e-3) << "it is where it was";
    const Point2 outward = (now.to_parent(point.position) - center).normalized();
    EXPECT_NEAR(
        angle_difference(now.heading() + point.theta, std::atan2(left_of(outward).y(), left_of(outward).x())),
        0.0, 2e-4);
    EXPECT_NEAR(point.kappa, kappa, 5e-5);
  }
  EXPECT_GT(trusted, 25u);
  EXPECT_NEAR(path.path.s_at_vehicle, 2.0 + 3.0, 0.05) << "the vehicle has come 3 m along it";
  EXPECT_NEAR(path.path.l, 0.2 - 0.4, 0.02);
}

TEST(MarkerPath, StartsAtOrBehindTheVehicleWhereverTheCameraIs) {
  // 1.9 m ahead of the rear axle, and the vehicle has rolled back by half a metre since.
  const MarkerPath path = path_of(lane_about({0.2, 0.01}), Pose2(Point2(2.4, 0.0), 0.0));
  EXPECT_LE(path.path.points.front().position.x(), 0.0);
  EXPECT_NEAR(path.path.s_at_vehicle, -path.path.points.front().position.x(), 0.05);
}

}  // namespace
}  // namespace relative_map::core
