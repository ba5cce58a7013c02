#include "relative_map/route/reference_line.hpp"

#include <gmock/gmock.h>

#include <random>

#include "relative_map/route/box_smoother.hpp"
#include "relative_map/route/route_map.hpp"
#include "support/lane_graphs.hpp"

namespace relative_map::core {
namespace {

std::vector<Anchor> anchors_on(const Polyline& points, double bound) {
  std::vector<Anchor> anchors;
  for (const Point2& point : points) anchors.push_back({point, Point2::UnitY(), -bound, bound, 0.0});
  anchors.front().lower = anchors.front().upper = anchors.back().lower = anchors.back().upper = 0.0;
  return anchors;
}

double third_differences(const std::vector<Anchor>& anchors, const std::vector<double>& offsets) {
  double sum = 0.0;
  const auto at = [&](std::size_t i) -> Point2 { return anchors[i].point + offsets[i] * anchors[i].left; };
  for (std::size_t i = 3; i < anchors.size(); ++i) {
    sum += (at(i) - 3.0 * at(i - 1) + 3.0 * at(i - 2) - at(i - 3)).squaredNorm();
  }
  return sum;
}

TEST(BoxSmoother, WhereNothingBindsItIsALeastSquaresFit) {
  // A parabola has no third difference: it is its own answer, wherever it was drawn to.
  Polyline points;
  for (int i = 0; i < 40; ++i) points.emplace_back(i, 0.01 * i * i);
  for (const double offset : smooth_within(anchors_on(points, 0.5), 1e-6)) EXPECT_NEAR(offset, 0.0, 1e-6);
}

TEST(BoxSmoother, KeepsTheBoundsAndIsNoWorseThanAnythingNearIt) {
  for (unsigned seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 0.2);
    Polyline points;
    for (int i = 0; i < 60; ++i) points.emplace_back(i, noise(random));
    const auto anchors = anchors_on(points, 0.15);
    const auto offsets = smooth_within(anchors, 0.0);
    ASSERT_EQ(offsets.size(), anchors.size());
    const double best = third_differences(anchors, offsets);
    for (std::size_t i = 0; i < offsets.size(); ++i) {
      EXPECT_GE(offsets[i], anchors[i].lower - 1e-4);
      EXPECT_LE(offsets[i], anchors[i].upper + 1e-4);
      // Of a convex program a local minimum is the minimum.
      for (const double step : {-0.01, 0.01}) {
        auto moved = offsets;
        moved[i] = std::clamp(moved[i] + step, anchors[i].lower, anchors[i].upper);
        EXPECT_GE(third_differences(anchors, moved), best - 1e-6) << seed;
      }
    }
  }
}

struct Ride {
  explicit Ride(const LaneGraph& graph, const Route& route, const ReferenceLineParam& param = {})
      : map(RouteParam{}), maker(test::prepared(graph), param) {
    map.set_graph(test::prepared(graph));
    const RouteStatus status = map.set_route(route);
    EXPECT_EQ(status.code, RouteCode::kOk) << status.message;
  }
  ReferenceLine at(const Point2& point, double heading) {
    const RouteUpdate update = map.update(Pose2(point, heading), 10.0);
    EXPECT_EQ(update.status.code, RouteCode::kOk) << update.status.message;
    return maker.make(update.segments, point).at(0);
  }
  RouteMap map;
  ReferenceLineMaker maker;
};

Point2 point_at(const ReferenceLine& line, double s) {
  PathPoints path;
  for (const ReferencePoint& point : line.points) path.push_back(point.path);
  std::size_t hint = 0;
  return interpolate(path, s, hint).position;
}

double distance_to(const ReferenceLine& line, const Point2& point) {
  double best = 1e9;
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    best = std::min(best,
                    project_on_segment(line.points[i - 1].path.position, line.points[i].path.position, point)
                        .squared_distance);
  }
  return std::sqrt(best);
}

Route along(const LaneGraph& graph) {
  std::vector<LaneSegment> segments;
  for (const GraphLane& lane : graph.lanes) segments.push_back({lane.id, 0.0, chord_length(lane.centerline)});
  return test::one_passage_roads(segments);
}

TEST(ReferenceLine, OfAStraightLaneIsItsCenterline) {
  Ride ride(test::grid(1, 4), along(test::grid(1, 4)));
  const ReferenceLine line = ride.at({120.0, 0.3}, 0.0);
  ASSERT_GT(line.points.size(), 200u);
  EXPECT_NEAR(line.points.front().path.position.x(), 70.0, 1e-9);
  EXPECT_NEAR(line.points.back().path.position.x(), 300.0, 1e-9);
  EXPECT_NEAR(line.s, 50.0, 1e-9);
  for (const ReferencePoint& point : line.points) {
    EXPECT_NEAR(point.path.position.y(), 0.0, 1e-6);
    EXPECT_NEAR(point.path.kappa, 0.0, 1e-6);
    EXPECT_EQ(point.left_half_width, 1.75);
    EXPECT_EQ(point.speed_limit, 13.9);
  }
}

/// A circle of chords of `chord` [m], as maps have them.
LaneGraph coarse_bend(double radius, double chord) {
  LaneGraph graph;
  Polyline points = {{-60.0, 0.0}};
  for (double angle = 0.0; angle < kPi / 2.0; angle += chord / radius) {
    points.emplace_back(radius * std::sin(angle), radius * (1.0 - std::cos(angle)));
  }
  graph.lanes.push_back(test::make_lane("bend", points));
  return graph;
}

TEST(ReferenceLine, OfACoarseBendIsSmoothAndInItsLane) {
  const LaneGraph graph = coarse_bend(80.0, 8.0);
  Ride ride(graph, along(graph));
  const ReferenceLine line = ride.at({0.0, 0.0}, 0.0);
  double greatest = 0.0, change = 0.0;
  for (const ReferencePoint& point : line.points) {
    EXPECT_LE(std::abs(point.l), 0.5 + 1e-3);
    const double left = (point.path.s - line.points.back().path.s);
    if (left < -20.0) greatest = std::max(greatest, std::abs(point.path.kappa));
    if (left < -20.0) change = std::max(change, std::abs(point.path.dkappa));
  }
  // The centerline itself turns by 0.1 rad at each vertex: 0.1 1/m over a meter.
  EXPECT_NEAR(greatest, 1.0 / 80.0, 0.003);
  EXPECT_LT(change, 0.002);
}

TEST(ReferenceLine, TakesTheNoiseOutOfACenterline) {
  std::mt19937 random(7);
  std::normal_distribution<double> noise(0.0, 0.05);
  LaneGraph graph = test::grid(1, 4);
  for (GraphLane& lane : graph.lanes) {
    for (std::size_t i = 1; i + 1 < lane.centerline.size(); ++i) lane.centerline[i].y() += noise(random);
  }
  Ride ride(graph, along(graph));
  double greatest = 0.0, turns = 0.0;
  for (const ReferencePoint& point : ride.at({120.0, 0.0}, 0.0).points) {
    greatest = std::max(greatest, std::abs(point.path.kappa));
  }
  for (const GraphLane& lane : graph.lanes) {
    const LaneLine line(lane.centerline);
    for (const PathPoint& point : line.points()) {
      turns = std::max(
          turns, std::abs(angle_difference(line.heading_at(point.s + 0.5), line.heading_at(point.s - 0.5))));
    }
  }
  // Over the meter about a vertex the centerline turns by so much [rad]: a sixth of it is left.
  EXPECT_LT(greatest, turns / 6.0);
}

// What the vehicle has driven on does not move.
TEST(ReferenceLine, DoesNotMoveUnderTheVehicle) {
  const LaneGraph bend = coarse_bend(60.0, 6.0), ring = test::ring(4, 50.0);
  for (const LaneGraph* graph : {&bend, &ring}) {
    Ride ride(*graph, along(*graph));
    Point2 vehicle = graph->lanes[0].centerline[1];
    ReferenceLine line = ride.at(vehicle, 0.0 + (graph == &ring ? kPi / 2.0 : 0.0));
    for (int tick = 0; tick < 100; ++tick) {
      const Point2 next = point_at(line, line.s + 0.8), after = point_at(line, line.s + 1.6);
      const double heading = std::atan2((after - next).y(), (after - next).x());
      const ReferenceLine before = line;
      line = ride.at(next, heading);
      ASSERT_GT(line.points.size(), 5u);
      EXPECT_LT(distance_to(line, next), 0.02) << tick;
      for (double ahead = -20.0; ahead < 25.0; ahead += 5.0) {
        const double s = line.s + ahead;
        if (s < 1.0 || s > line.points.back().path.s - 1.0) continue;
        if (s > before.points.back().path.s - 30.0) continue;
        EXPECT_LT(distance_to(before, point_at(line, s)), 0.02) << tick << " at " << ahead;
      }
    }
  }
}

TEST(ReferenceLine, KeepsAwayFromACurb) {
  LaneGraph graph = test::grid(1, 4);
  for (GraphLane& lane : graph.lanes) lane.right_paint = {{0.0, BoundaryType::kCurb}};
  Ride ride(graph, along(graph));
  const ReferenceLine line = ride.at({120.0, 0.0}, 0.0);
  EXPECT_NEAR(line.points[100].l, 0.1, 1e-3);
}

TEST(ReferenceLine, BendsBoundTheSpeed) {
  const LaneGraph graph = coarse_bend(40.0, 2.0);
  ReferenceLineParam param;
  param.lateral_acceleration = 1.5;
  Ride ride(graph, along(graph), param);
  const ReferenceLine line = ride.at({-30.0, 0.0}, 0.0);
  EXPECT_NEAR(line.points[10].speed_limit, 13.9, 0.5);
  EXPECT_NEAR(line.points[line.points.size() / 2 + 30].speed_limit, std::sqrt(1.5 * 40.0), 0.5);
}

// Its last point moves on with the vehicle, and must not make a bend that is none.
TEST(ReferenceLine, EndsWithoutABend) {
  const LaneGraph graph = coarse_bend(80.0, 8.0);
  Ride ride(graph, along(graph));
  Point2 vehicle(-55.0, 0.0);
  ReferenceLine line = ride.at(vehicle, 0.0);
  for (int tick = 0; tick < 80; ++tick) {
    vehicle = point_at(line, line.s + 0.73);
    const Point2 ahead = point_at(line, line.s + 1.5) - vehicle;
    line = ride.at(vehicle, std::atan2(ahead.y(), ahead.x()));
    for (std::size_t i = line.points.size() - 10; i < line.points.size(); ++i) {
      EXPECT_LT(std::abs(line.points[i].path.kappa), 2.0 / 80.0) << tick;
    }
  }
}

TEST(ReferenceLine, ArcLengthAndHeadingAreThoseOfItsPoints) {
  const LaneGraph graph = coarse_bend(60.0, 6.0);
  Ride ride(graph, along(graph));
  const ReferenceLine line = ride.at({0.0, 0.0}, 0.0);
  EXPECT_EQ(line.points.front().path.s, 0.0);
  for (std::size_t i = 1; i < line.points.size(); ++i) {
    const Point2 chord = line.points[i].path.position - line.points[i - 1].path.position;
    EXPECT_NEAR(line.points[i].path.s - line.points[i - 1].path.s, chord.norm(), 1e-9);
    EXPECT_LT(std::abs(angle_difference(std::atan2(chord.y(), chord.x()), line.points[i].path.theta)), 0.03);
  }
}

}  // namespace
}  // namespace relative_map::core
