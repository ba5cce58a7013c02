#include "relative_map/pipeline/fixed_weight/lane_fusion.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "support/lines.hpp"
#include "support/markers.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::lane_about;
using test::straight;

constexpr double kFade = 50.0;  // [m]

/// The vehicle's lane from a line in the body frame.
LanePath lane_on(const Polyline& points) {
  LanePath lane;
  lane.points = test::path_through(points);
  locate_vehicle(lane);
  return lane;
}

LanePath straight_lane() {
  return lane_on(straight(Pose2(Point2(-1.2, 0.0), 0.0), 250.0, 0.4));
}

MarkerPath markers_about(const Cubic& center, double view_range = 50.0) {
  return std::get<MarkerPath>(make_marker_path(lane_about(center, 1.75, view_range), Pose2(), 20.0,
                                               MapParam(), NavigationLaneParam()));
}

/// The curvature of the circles through each three points, and the path's own beside it.
void expect_geometry_is_that_of_the_points(const LanePath& lane) {
  const PathPoints computed = test::path_through(positions_of(lane.points));
  for (std::size_t i = 0; i < computed.size(); ++i) {
    EXPECT_NEAR(lane.points[i].s, computed[i].s, 1e-9);
    EXPECT_NEAR(angle_difference(lane.points[i].theta, computed[i].theta), 0.0, 1e-9);
    EXPECT_NEAR(lane.points[i].kappa, computed[i].kappa, 1e-9);
    EXPECT_NEAR(lane.points[i].dkappa, computed[i].dkappa, 1e-9);
  }
}

double sharpest_step_of_curvature(const PathPoints& points) {
  double sharpest = 0.0;
  for (std::size_t i = 2; i + 1 < points.size(); ++i) {
    sharpest = std::max(sharpest, std::abs(points[i].kappa - points[i - 1].kappa));
  }
  return sharpest;
}

TEST(Fusion, OfWeightZeroIsTheLineExactly) {
  LanePath lane = lane_on(arc(Pose2(Point2(-1.0, 0.3), 0.02), 0.004, 200.0, 0.4));
  const LanePath line = lane;
  fuse_fixed_weight(markers_about({0.8, 0.03, 5e-4, 0.0}), 0.0, kFade, lane);
  ASSERT_EQ(lane.points.size(), line.points.size());
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    EXPECT_EQ(lane.points[i].position, line.points[i].position);
    EXPECT_EQ(lane.points[i].theta, line.points[i].theta);
    EXPECT_EQ(lane.points[i].kappa, line.points[i].kappa);
    EXPECT_EQ(lane.points[i].s, line.points[i].s);
  }
}

TEST(Fusion, OfParallelStraightsMovesTheLaneByTheWeight) {
  LanePath lane = straight_lane();
  const FusionState state = fuse_fixed_weight(markers_about({0.8}), 0.25, kFade, lane);
  for (const PathPoint& point : lane.points) {
    if (point.position.x() <= 50.0) {
      EXPECT_NEAR(point.position.y(), 0.2, 1e-12) << "behind the vehicle too";
    } else if (point.position.x() >= 100.0) {
      EXPECT_EQ(point.position.y(), 0.0) << "past the fade there is the line alone";
    } else {
      const double t = (point.position.x() - 50.0) / kFade;
      EXPECT_NEAR(point.position.y(), 0.2 * (1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t)), 1e-9);
    }
  }
  EXPECT_EQ(state.source, Source::kFused);
  EXPECT_EQ(state.method, "fixed_weight");
  EXPECT_NEAR(state.lateral_offset.value, 0.2, 1e-12);
  EXPECT_NEAR(state.heading_offset.value, 0.0, 1e-12);
  EXPECT_NEAR(state.marker_range, 50.0, 1e-9);
  EXPECT_NEAR(lane.l, -0.2, 1e-12) << "the vehicle is right of the lane now";
  expect_geometry_is_that_of_the_points(lane);
}

TEST(Fusion, TellsTheHeadingItApplied) {
  LanePath lane = straight_lane();
  const FusionState state = fuse_fixed_weight(markers_about({0.0, 0.02}), 0.5, kFade, lane);
  EXPECT_NEAR(state.heading_offset.value, 0.5 * std::atan(0.02), 1e-9);
}

TEST(Fusion, OfWeightOneIsTheMarkersInsideTheirViewRange) {
  const Cubic center{0.5, 0.02, 2e-3, 1e-5};
  LanePath lane = lane_on(arc(Pose2(Point2(-1.0, 0.3), 0.02), 0.004, 250.0, 0.4));
  const MarkerPath markers = markers_about(center);
  fuse_fixed_weight(markers, 1.0, kFade, lane);
  std::size_t inside = 0;
  for (const PathPoint& point : lane.points) {
    const double x = point.position.x();
    if (x < 1.0 || x > 49.0) continue;
    ++inside;
    EXPECT_NEAR(point.position.y(), center.value(x), 1e-5) << "at x = " << x;
    EXPECT_NEAR(point.theta, std::atan(center.slope(x)), 1e-4) << "at x = " << x;
    EXPECT_NEAR(point.kappa, center.kappa(x), 2e-4) << "at x = " << x;
  }
  EXPECT_GT(inside, 100u);
  expect_geometry_is_that_of_the_points(lane);
}

TEST(Fusion, PastTheFadeIsTheLineExactly) {
  const LanePath line = lane_on(arc(Pose2(Point2(-1.0, 0.3), 0.02), 0.004, 250.0, 0.4));
  LanePath lane = line;
  fuse_fixed_weight(markers_about({0.5, 0.05, 1e-3, 0.0}), 0.7, kFade, lane);
  for (std::size_t i = 0; i < line.points.size(); ++i) {
    if (line.points[i].s < 2.0 + 50.0 + kFade) continue;
    EXPECT_EQ(lane.points[i].position, line.points[i].position);
  }
}

TEST(Fusion, IsSmoothInHeadingAndCurvature) {
  // A jump is as high however finely the line is sampled; a slope's steps become smaller.
  const auto sharpest_step = [](const Cubic& center, double spacing) {
    LanePath lane = lane_on(straight(Pose2(Point2(-1.2, 0.0), 0.0), 250.0, spacing));
    LaneMarkers seen = lane_about(center);
    seen.left.longitude_start = seen.right.longitude_start = 8.0;
    const MarkerPath markers =
        std::get<MarkerPath>(make_marker_path(seen, Pose2(), 20.0, MapParam(), NavigationLaneParam()));
    fuse_fixed_weight(markers, 1.0, kFade, lane);
    return sharpest_step_of_curvature(lane.points);
  };
  for (const Cubic& center : {Cubic{0.5}, Cubic{0.5, 0.05}, Cubic{-0.3, 0.0, 1e-3, 0.0}}) {
    const double coarse = sharpest_step(center, 0.4), fine = sharpest_step(center, 0.1);
    EXPECT_LT(coarse, 5e-3);
    EXPECT_LT(fine, 0.4 * coarse) << center.c0 << " " << center.c1 << " " << center.c2;
  }
  // With a third derivative the slopes at the ends are good to 0.6 mrad.
  for (const Cubic& center : {Cubic{0.0, 0.0, 0.0, 1e-5}, Cubic{0.2, -0.04, 5e-4, 1e-5}}) {
    EXPECT_LT(0.1 * sharpest_step(center, 0.1), 6e-4);
  }
}

TEST(Fusion, DoesNotMakeANoisyLineWorse) {
  // A raw recording: 1 cm of noise every 0.4 m. The fade's slope is taken from such points, so it is off by
  // some of them over its length.
  Polyline points = straight(Pose2(Point2(-1.2, 0.0), 0.0), 250.0, 0.4);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> noise(-0.01, 0.01);
  for (Point2& point : points) point += Point2(noise(random), noise(random));
  LanePath lane = lane_on(points);
  fuse_fixed_weight(markers_about({0.8}), 1.0, kFade, lane);
  for (std::size_t i = 0; i < points.size(); ++i) {
    const double t = std::clamp((points[i].x() - 50.0) / kFade, 0.0, 1.0);
    const double smooth = 0.8 * (1.0 - t * t * t * (10.0 - 15.0 * t + 6.0 * t * t));
    EXPECT_NEAR(lane.points[i].position.y(), smooth, 0.06) << "at x = " << points[i].x();
  }
}

TEST(Fusion, HoldsTheCorrectionWellBehindTheFirstPaint) {
  LanePath lane = lane_on(straight(Pose2(Point2(-60.0, 0.0), 0.0), 250.0, 0.5));
  LaneMarkers seen = lane_about({0.5, 0.02});
  seen.left.longitude_start = seen.right.longitude_start = 10.0;
  const MarkerPath markers =
      std::get<MarkerPath>(make_marker_path(seen, Pose2(), 20.0, MapParam(), NavigationLaneParam()));
  fuse_fixed_weight(markers, 0.5, kFade, lane);
  for (const PathPoint& point : lane.points) {
    if (point.position.x() < -12.0) {
      EXPECT_NEAR(point.position.y(), 0.5 * 0.7, 2e-3);
    } else if (point.position.x() < 10.0) {
      EXPECT_NEAR(point.position.y(), 0.5 * 0.7, 0.06);
    }
  }
}

TEST(Fusion, IsTheSameWhicheverWayTheFrameIsTurned) {
  // Headings near +-pi must not average to 0.
  const LanePath line = lane_on(arc(Pose2(Point2(-1.0, 0.3), 0.02), -0.004, 150.0, 0.4));
  const MarkerPath markers = markers_about({0.4, -0.03, 3e-4, 0.0});
  LanePath straight_on = line;
  const FusionState state = fuse_fixed_weight(markers, 0.5, kFade, straight_on);
  const Pose2 about(Point2::Zero(), kPi);
  const auto turned = [&](LanePath lane) {
    for (PathPoint& point : lane.points) {
      point.position = about.to_parent(point.position);
      point.direction = about.rotate_to_parent(point.direction);
      point.theta = normalize_angle(point.theta + kPi);
    }
    return lane;
  };
  MarkerPath turned_markers = markers;
  turned_markers.path = turned(markers.path);
  LanePath turned_lane = turned(line);
  const FusionState turned_state = fuse_fixed_weight(turned_markers, 0.5, kFade, turned_lane);
  const LanePath expected = turned(straight_on);
  for (std::size_t i = 0; i < expected.points.size(); ++i) {
    EXPECT_NEAR((turned_lane.points[i].position - expected.points[i].position).norm(), 0.0, 1e-9);
    EXPECT_NEAR(angle_difference(turned_lane.points[i].theta, expected.points[i].theta), 0.0, 1e-9);
  }
  EXPECT_NEAR(turned_state.lateral_offset.value, state.lateral_offset.value, 1e-9);
  EXPECT_NEAR(turned_state.heading_offset.value, state.heading_offset.value, 1e-9);
}

TEST(Trust, StaysWhereLineAndMarkersAreOfOneLane) {
  MarkerPath markers = markers_about({0.8, 0.02});
  EXPECT_FALSE(trust_within_lane(straight_lane(), markers));
  EXPECT_NEAR(markers.trusted_from, 2.0, 1e-3);
  EXPECT_NEAR(markers.trusted_to, 52.0, 0.02);
}

TEST(Trust, EndsWhereTheMarkersLeaveTheLane) {
  MarkerPath markers = markers_about({0.5, 0.0, 2e-3, 0.0});  // 2.5 m beside it after 31.6 m
  EXPECT_FALSE(trust_within_lane(straight_lane(), markers));
  EXPECT_NEAR(markers.trusted_to, 2.0 + 31.6, 1.1);
  MarkerPath turned = markers_about({-1.0, 0.2, 2e-3, 0.0});  // askew by 0.3 rad after 27 m
  EXPECT_FALSE(trust_within_lane(straight_lane(), turned));
  EXPECT_LT(turned.trusted_to, 2.0 + 27.0);
}

TEST(Trust, IsNotGivenToAnotherLanesMarkers) {
  MarkerPath beside = markers_about({3.5});
  EXPECT_TRUE(trust_within_lane(straight_lane(), beside));
  MarkerPath askew = markers_about({0.0, 0.5});
  EXPECT_TRUE(trust_within_lane(straight_lane(), askew));
}

TEST(Fusion, TakesTheHalfWidthsThatWereSeen) {
  LanePath lane = straight_lane();
  MarkerPath markers = markers_about({0.0});
  markers.path.left_half_width = 1.6;
  markers.path.right_half_width = 1.7;
  fuse_fixed_weight(markers, 0.1, kFade, lane);
  EXPECT_EQ(lane.left_half_width, 1.6);
  EXPECT_EQ(lane.right_half_width, 1.7);
}

TEST(Fusion, AlignsByArcLengthFromTheVehicle) {
  // A bend that both know of, but the line 3 m later: with equal weights it comes half way between.
  Polyline late = straight(Pose2(Point2(-2.0, 0.0), 0.0), 12.0, 0.5);
  const Polyline bend = arc(Pose2(Point2(10.5, 0.0), 0.0), 0.02, 60.0, 0.5);
  late.insert(late.end(), bend.begin(), bend.end());
  LanePath lane = lane_on(late);
  MarkerPath markers;
  Polyline early = straight(Pose2(Point2(-2.0, 0.0), 0.0), 9.0, 0.5);
  const Polyline early_bend = arc(Pose2(Point2(7.5, 0.0), 0.0), 0.02, 60.0, 0.5);
  early.insert(early.end(), early_bend.begin(), early_bend.end());
  markers.path = lane_on(early);
  markers.trusted_to = markers.path.points.back().s;
  const LanePath line = lane;
  fuse_fixed_weight(markers, 0.5, kFade, lane);
  std::size_t hint = 0;
  for (std::size_t i = 0; line.points[i].s <= markers.trusted_to; ++i) {
    const Point2 other = interpolate_smoothly(markers.path.points, line.points[i].s, hint).position;
    EXPECT_NEAR((lane.points[i].position - 0.5 * (line.points[i].position + other)).norm(), 0.0, 1e-9);
  }
}

}  // namespace
}  // namespace relative_map::core
