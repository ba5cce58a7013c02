#include "relative_map/simulation/road.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <stdexcept>

#include "relative_map/simulation/road_description.hpp"

namespace relative_map::core {
namespace {

/// The clothoid's position by Simpson's rule in steps far finer than its turns: an independent quadrature.
Point2 clothoid_by_simpson(double length, double kappa_start, double kappa_end) {
  const double rate = (kappa_end - kappa_start) / length;
  const auto tangent = [&](double u) { return std::polar(1.0, u * (kappa_start + 0.5 * rate * u)); };
  const int steps = 20000;
  const double h = length / steps;
  std::complex<double> sum = tangent(0.0) + tangent(length);
  for (int i = 1; i < steps; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * tangent(i * h);
  sum *= h / 3.0;
  return {sum.real(), sum.imag()};
}

TEST(RoadShape, AStraightIsStraight) {
  const RoadShape road = RoadShape(Pose2(Point2(10.0, -5.0), 0.5)).add_straight(100.0);
  EXPECT_EQ(road.length(), 100.0);
  const PathPoint point = road.at(70.0);
  EXPECT_NEAR(point.position.x(), 10.0 + 70.0 * std::cos(0.5), 1e-12);
  EXPECT_NEAR(point.position.y(), -5.0 + 70.0 * std::sin(0.5), 1e-12);
  EXPECT_EQ(point.theta, 0.5);
  EXPECT_EQ(point.kappa, 0.0);
  EXPECT_EQ(point.dkappa, 0.0);
  EXPECT_EQ(point.s, 70.0);
}

TEST(RoadShape, AnArcIsACircle) {
  for (const double radius : {50.0, -300.0}) {
    const RoadShape road = RoadShape().add_arc(400.0, 1.0 / radius);
    for (double s = 0.0; s <= 400.0; s += 7.0) {
      const PathPoint point = road.at(s);
      EXPECT_NEAR(point.position.x(), radius * std::sin(s / radius), 1e-10);
      EXPECT_NEAR(point.position.y(), radius * (1.0 - std::cos(s / radius)), 1e-10);
      EXPECT_NEAR(angle_difference(point.theta, s / radius), 0.0, 1e-12);
      EXPECT_EQ(point.kappa, 1.0 / radius);
    }
  }
}

TEST(RoadShape, AClothoidIsItsIntegral) {
  const RoadShape gentle = RoadShape().add_clothoid(100.0, 0.0, 0.01);
  const RoadShape sharp = RoadShape().add_clothoid(100.0, -0.05, 0.2);
  EXPECT_LT((gentle.at(100.0).position - clothoid_by_simpson(100.0, 0.0, 0.01)).norm(), 1e-10);
  EXPECT_LT((sharp.at(100.0).position - clothoid_by_simpson(100.0, -0.05, 0.2)).norm(), 1e-10);
  const PathPoint middle = gentle.at(50.0);
  EXPECT_LT((middle.position - clothoid_by_simpson(50.0, 0.0, 0.005)).norm(), 1e-10);
  EXPECT_NEAR(middle.theta, 0.5 * 50.0 * 0.005, 1e-15);
  EXPECT_NEAR(middle.kappa, 0.005, 1e-15);
  EXPECT_NEAR(middle.dkappa, 1e-4, 1e-18);
}

TEST(RoadShape, PiecesMeetWithOneTangent) {
  const RoadShape road = demo_road();
  EXPECT_NEAR(road.length(), 1080.0, 1e-9);
  for (double s = 0.0; s + 0.1 <= road.length(); s += 0.1) {
    const PathPoint here = road.at(s), next = road.at(s + 0.1);
    EXPECT_NEAR((next.position - here.position).norm(), 0.1, 1e-6);
    EXPECT_NEAR(angle_difference(next.theta, here.theta), 0.1 * 0.5 * (here.kappa + next.kappa), 1e-5);
    EXPECT_LE(std::abs(next.kappa), 1.0 / 60.0 + 1e-12);
  }
}

TEST(RoadShape, MapSizedCoordinatesCostNoDigits) {
  const Point2 origin(691188.668784, 3118142.638383);
  const RoadShape near = demo_road(Pose2(Point2::Zero(), 1.5)), far = demo_road(Pose2(origin, 1.5));
  for (double s = 0.0; s <= near.length(); s += 10.0) {
    EXPECT_LT((far.at(s, 3.5).position - origin - near.at(s, 3.5).position).norm(), 2e-9);
  }
}

TEST(RoadShape, ParallelsKeepTheirDistanceAndTheirGeometry) {
  const RoadShape road = demo_road();
  for (const double l : {3.5, -3.5, 10.0}) {
    for (double s = 0.05; s < road.length(); s += 3.7) {
      const PathPoint center = road.at(s), beside = road.at(s, l);
      const Point2 apart = beside.position - center.position;
      EXPECT_NEAR(left_of(center.direction).dot(apart), l, 1e-10);
      EXPECT_NEAR(center.direction.dot(apart), 0.0, 1e-10);
      EXPECT_EQ(beside.theta, center.theta);
      // Its own arc length, theta and kappa must fit one another.
      const PathPoint ahead = road.at(s + 1e-3, l);
      const double ds = ahead.s - beside.s;
      EXPECT_NEAR((ahead.position - beside.position).norm(), ds, 1e-9);
      EXPECT_NEAR(angle_difference(ahead.theta, beside.theta), ds * beside.kappa, 1e-8);
      EXPECT_NEAR(ahead.kappa - beside.kappa, ds * beside.dkappa, 1e-7);
    }
  }
}

TEST(RoadShape, AnOffsetBeyondTheCentreIsRefused) {
  const RoadShape road = RoadShape().add_arc(100.0, 0.05);
  EXPECT_NO_THROW(road.at(10.0, 19.9));
  EXPECT_THROW(road.at(10.0, 20.1), std::out_of_range);
  EXPECT_THROW(road.lane(25.0, 1.0), std::out_of_range);
  EXPECT_THROW(RoadShape().at(0.0), std::out_of_range);
}

TEST(RoadShape, ALaneIsSampledEvenlyFromEndToEnd) {
  const RoadShape road = demo_road();
  const RecordedLine lane = road.lane(-3.5, 0.4, "right");
  EXPECT_EQ(lane.name, "right");
  ASSERT_EQ(lane.points.size(), 2701u);
  EXPECT_EQ(lane.points.front().s, 0.0);
  EXPECT_EQ(lane.points.back().x, road.at(road.length(), -3.5).position.x());
  for (std::size_t i = 1; i < lane.points.size(); ++i) {
    const LinePoint &a = lane.points[i - 1], &b = lane.points[i];
    EXPECT_NEAR(std::hypot(b.x - a.x, b.y - a.y), 0.4, 0.03);
    EXPECT_NEAR(b.s - a.s, std::hypot(b.x - a.x, b.y - a.y), 1e-6);
    EXPECT_TRUE(std::isnan(b.z));
  }
}

TEST(RoadShape, LanesLieSideBySideFromTheLeft) {
  const RoadShape road = RoadShape().add_straight(10.0);
  const std::vector<RecordedLine> lanes = road.lanes(3, 3.5, 1.0);
  ASSERT_EQ(lanes.size(), 3u);
  for (std::size_t i = 0; i < lanes.size(); ++i) {
    EXPECT_EQ(lanes[i].name, "lane_" + std::to_string(i));
    EXPECT_EQ(lanes[i].priority, i);
    EXPECT_DOUBLE_EQ(lanes[i].points[4].y, 3.5 - 3.5 * static_cast<double>(i));
    EXPECT_DOUBLE_EQ(lanes[i].points[4].x, 4.0);
  }
  EXPECT_DOUBLE_EQ(road.lanes(2, 4.0, 1.0)[0].points[0].y, 2.0);
}

TEST(RoadShape, TheClosedRoadCloses) {
  const RoadShape road = closed_road(Pose2(Point2(691188.0, 3118142.0), 2.0));
  for (const double l : {0.0, 3.5, -3.5}) {
    const PathPoint start = road.at(0.0, l), end = road.at(road.length(), l);
    EXPECT_LT((end.position - start.position).norm(), 1e-8);
    EXPECT_NEAR(angle_difference(end.theta, start.theta), 0.0, 1e-12);
    EXPECT_NEAR(end.kappa, start.kappa, 1e-12);
    EXPECT_NEAR(end.s, road.length() - 2.0 * kPi * l, 1e-9);  // the lap turns once
  }
}

TEST(RoadShape, FaultyPiecesAreRefused) {
  EXPECT_THROW(RoadShape().add_straight(0.0), std::invalid_argument);
  EXPECT_THROW(RoadShape().add_straight(-1.0), std::invalid_argument);
  EXPECT_THROW(RoadShape().add_straight(std::nan("")), std::invalid_argument);
  EXPECT_THROW(RoadShape().add_arc(10.0, INFINITY), std::invalid_argument);
  EXPECT_THROW(RoadShape().add_straight(10.0).lane(0.0, 0.0), std::invalid_argument);
}

TEST(RoadDescription, IsReadPieceByPiece) {
  const RoadShape road = parse_road(" straight 100; clothoid 40 0.01 ;arc 60; clothoid 40 0; arc 5 -0.1;");
  EXPECT_EQ(road.length(), 245.0);
  EXPECT_NEAR(road.at(120.0).kappa, 0.005, 1e-15);
  EXPECT_EQ(road.at(170.0).kappa, 0.01);
  EXPECT_NEAR(road.at(220.0).kappa, 0.005, 1e-15);
  EXPECT_EQ(road.at(243.0).kappa, -0.1);
  EXPECT_NEAR(parse_road("clothoid 10 0.1 0.2").at(5.0).kappa, 0.15, 1e-15);
  EXPECT_EQ(parse_road("demo").length(), demo_road().length());
  EXPECT_EQ(parse_road("closed").length(), closed_road().length());
}

TEST(RoadDescription, NamesTheFaultyPiece) {
  for (const char* text : {"straight", "straight 1 2", "bend 5", "arc 5 x", "straight -5", "clothoid 5",
                           "clothoid 5 0 0 0", "straight 1e400"}) {
    try {
      parse_road(std::string("straight 1; ") + text);
      ADD_FAILURE() << text << " was taken";
    } catch (const std::invalid_argument& fault) {
      EXPECT_NE(std::string(fault.what()).find(text), std::string::npos) << fault.what();
    }
  }
  EXPECT_THROW(parse_road(""), std::invalid_argument);
  EXPECT_THROW(parse_road(" ; "), std::invalid_argument);
}

}  // namespace
}  // namespace relative_map::core
