#include "relative_map/pipeline/lines/navigation_line_tracker.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using test::arc;
using test::prepared;
using test::straight;
using test::vehicle_at;
using testing::HasSubstr;

constexpr double kMaxDistance = 15.0;
const Point2 kUtm(691191.9668313662, 3118215.5540518095);

/// Tracks from tick to tick, and expects to find the line each time.
class OnLine {
 public:
  explicit OnLine(NavigationLine line) : line_(std::move(line)) {}

  LineProjection at(const Pose2& pose, double speed = 10.0) {
    seconds_ += 0.1;
    const auto tracked = tracker_.track(line_, vehicle_at(pose, seconds_, speed), kMaxDistance);
    if (const auto* drop = std::get_if<LineDrop>(&tracked)) {
      ADD_FAILURE() << "dropped: " << drop->reason;
      return {};
    }
    return std::get<LineProjection>(tracked);
  }
  const NavigationLine& line() const { return line_; }

 private:
  NavigationLine line_;
  NavigationLineTracker tracker_;
  double seconds_ = 0.0;
};

LineDrop drop_at(const NavigationLine& line, const Pose2& pose) {
  NavigationLineTracker tracker;
  const auto tracked = tracker.track(line, vehicle_at(pose), kMaxDistance);
  EXPECT_TRUE(std::holds_alternative<LineDrop>(tracked));
  const auto* drop = std::get_if<LineDrop>(&tracked);
  return drop != nullptr ? *drop : LineDrop{StatusCode::kOk, ""};
}

TEST(Tracker, FindsThePlaceBesideAStraight) {
  const Pose2 start(kUtm, 2.0);
  OnLine on(prepared(straight(start, 100.0, 1.0)));
  const LineProjection left = on.at(start.to_parent(Pose2(Point2(40.3, 2.5), 0.1)));
  EXPECT_NEAR(left.s, 40.3, 1e-8);
  EXPECT_NEAR(left.l, 2.5, 1e-8) << "left of the line is positive";
  EXPECT_NEAR(left.distance, 2.5, 1e-8);
  EXPECT_NEAR(left.heading_offset, 0.1, 1e-8);
  EXPECT_NEAR(left.remaining, 59.7, 1e-8);
  EXPECT_EQ(left.nearest_vertex, 40u);
  const LineProjection right = on.at(start.to_parent(Pose2(Point2(40.6, -2.5), -0.1)));
  EXPECT_NEAR(right.l, -2.5, 1e-8);
  EXPECT_EQ(right.nearest_vertex, 41u);
}

TEST(Tracker, FindsThePlaceOnTheFirstAndTheLastSegment) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  EXPECT_NEAR(OnLine(line).at(Pose2(Point2(0.25, 1.0), 0.0)).s, 0.25, 1e-12);
  const LineProjection last = OnLine(line).at(Pose2(Point2(99.75, 1.0), 0.0));
  EXPECT_NEAR(last.s, 99.75, 1e-12);
  EXPECT_NEAR(last.remaining, 0.25, 1e-12);
  EXPECT_EQ(last.nearest_vertex, 100u);
}

TEST(Tracker, FindsThePlaceBetweenVerticesFarApart) {
  OnLine on(prepared(straight(Pose2(kUtm, 0.7), 600.0, 60.0)));
  const LineProjection place = on.at(Pose2(kUtm, 0.7).to_parent(Pose2(Point2(271.0, 1.0), 0.0)));
  EXPECT_NEAR(place.s, 271.0, 1e-8) << "30 m from any vertex";
  EXPECT_NEAR(place.l, 1.0, 1e-8);
}

TEST(Tracker, CountsOnBeforeTheStart) {
  OnLine on(prepared(straight(Pose2(), 100.0, 1.0)));
  const LineProjection place = on.at(Pose2(Point2(-8.0, 3.0), 0.0));
  EXPECT_NEAR(place.s, -8.0, 1e-12);
  EXPECT_NEAR(place.l, 3.0, 1e-12);
  EXPECT_NEAR(place.distance, std::hypot(8.0, 3.0), 1e-12);
  EXPECT_EQ(place.nearest_vertex, 0u);
}

TEST(Tracker, DropsALineThatIsTooFarAwayAndSaysHowFar) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  EXPECT_NEAR(OnLine(line).at(Pose2(Point2(50.0, 14.9), 0.0)).l, 14.9, 1e-12);
  const LineDrop drop = drop_at(line, Pose2(Point2(50.0, 15.5), 0.0));
  EXPECT_EQ(drop.code, StatusCode::kOffRoute);
  EXPECT_THAT(drop.reason, HasSubstr("15.5 m"));
}

TEST(Tracker, DropsALineThatRunsTheOtherWay) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  const LineDrop drop = drop_at(line, Pose2(Point2(50.0, 1.0), kPi));
  EXPECT_EQ(drop.code, StatusCode::kOffRoute);
  EXPECT_THAT(drop.reason, HasSubstr("other way"));
}

TEST(Tracker, EndsPastTheEnd) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  EXPECT_EQ(drop_at(line, Pose2(Point2(100.5, 0.5), 0.0)).code, StatusCode::kLineEnd);
  EXPECT_EQ(drop_at(line, Pose2(Point2(110.0, 0.5), 0.0)).code, StatusCode::kLineEnd);
}

TEST(Tracker, FindsTheLineAgainAtOnceAfterAJump) {
  const Pose2 start(Point2::Zero(), 0.0);
  OnLine on(prepared(arc(start, 0.002, 1500.0, 0.5)));
  EXPECT_NEAR(on.at(test::along_arc(start, 0.002, 100.0)).s, 100.0, 1e-3);
  EXPECT_NEAR(on.at(test::along_arc(start, 0.002, 900.0)).s, 900.0, 1e-3) << "forward";
  EXPECT_NEAR(on.at(test::along_arc(start, 0.002, 30.0)).s, 30.0, 1e-3) << "backward";
}

TEST(Tracker, FollowsAReversingVehicle) {
  const Pose2 start(Point2::Zero(), 1.0);
  OnLine on(prepared(arc(start, 0.02, 200.0, 0.5)));
  for (double s = 150.0; s > 0.0; s -= 0.3) {
    EXPECT_NEAR(on.at(test::along_arc(start, 0.02, s), -3.0).s, s, 1e-3);
  }
}

/// A lap of two loops that cross at right angles in the origin, about 360 m long.
Pose2 figure_eight(double t) {
  const Point2 position(60.0 * std::sin(t), 40.0 * std::sin(2.0 * t));
  return {position, std::atan2(80.0 * std::cos(2.0 * t), 60.0 * std::cos(t))};
}

NavigationLine prepared_figure_eight() {
  Polyline points;
  for (int i = 0; i < 700; ++i) points.push_back(figure_eight(0.3 + 2.0 * kPi * i / 700.0).position());
  const NavigationLine line = prepared(points);
  EXPECT_TRUE(line.closed());
  return line;
}

TEST(Tracker, DrivesThroughTheCrossingOfAFigureEight) {
  OnLine on(prepared_figure_eight());
  double previous = on.at(figure_eight(0.35)).s;
  for (double t = 0.355; t < 0.35 + 4.0 * kPi; t += 0.005) {  // two laps, 0.2 to 0.5 m a step
    const double s = on.at(figure_eight(t)).s;
    const double step = std::remainder(s - previous, on.line().length);
    EXPECT_GT(step, 0.0) << "at t = " << t;
    EXPECT_LT(step, 0.6) << "at t = " << t;
    previous = s;
  }
}

TEST(Tracker, StaysOnItsBranchWhereTheVehicleTurnsAtTheCrossing) {
  // 40 degrees off the branch that it is on, and 57 degrees off the other one: the branch that it came on
  // counts, even where the other one is a little nearer.
  OnLine on(prepared_figure_eight());
  const double before = on.at(figure_eight(-0.02)).s;
  const Pose2 turned(Point2(0.3, 0.1), figure_eight(0.0).heading() - 0.7);
  EXPECT_NEAR(std::remainder(on.at(turned).s - before, on.line().length), 1.8, 0.6);
}

TEST(Tracker, TakesTheBranchThatFitsTheHeadingWhereItComesToTheCrossingFresh) {
  const NavigationLine line = prepared_figure_eight();
  for (const double t : {0.0, kPi}) {
    const Pose2 crossing = figure_eight(t);
    const LineProjection place =
        OnLine(line).at(Pose2(Point2(0.05, -0.05), normalize_angle(crossing.heading() + 0.2)));
    EXPECT_NEAR(place.heading_offset, 0.2, 0.05);
  }
}

TEST(Tracker, CountsOnAcrossTheSeamOfALap) {
  OnLine on(prepared(test::circle(30.0, 190)));
  double previous = on.at(test::along_arc(Pose2(Point2(30.0, 0.0), kPi / 2.0), 1.0 / 30.0, -20.0)).s;
  for (double driven = -19.7; driven < 20.0; driven += 0.3) {
    const LineProjection place =
        on.at(test::along_arc(Pose2(Point2(30.0, 0.0), kPi / 2.0), 1.0 / 30.0, driven));
    EXPECT_GE(place.s, 0.0);
    EXPECT_LT(place.s, on.line().length);
    EXPECT_NEAR(std::remainder(place.s - previous, on.line().length), 0.3, 0.01);
    EXPECT_NEAR(place.remaining, on.line().length, 1e-12) << "a lap never ends";
    previous = place.s;
  }
}

TEST(Tracker, KeepsItsTurnOfASpiralRamp) {
  // Three turns one above the other: the same x and y three times.
  const Pose2 start(Point2(15.0, 0.0), kPi / 2.0);
  const NavigationLine ramp = prepared(arc(start, 1.0 / 15.0, 3.0 * 2.0 * kPi * 15.0, 0.5), false);
  OnLine on(ramp);
  for (double s = 5.0; s < 280.0; s += 0.4) {
    EXPECT_NEAR(on.at(test::along_arc(start, 1.0 / 15.0, s), 4.0).s, s, 0.1);
  }
}

TEST(Tracker, KeepsItsPassWhereTheLineComesBackCloseBy) {
  // Out, round, and past the start again 1.2 m to the right, in the same direction.
  Polyline points = straight(Pose2(), 60.0, 0.5);
  const Polyline round = arc(Pose2(Point2(60.0, 0.0), 0.0), 1.0 / 20.0, 2.0 * kPi * 20.0, 0.5);
  points.insert(points.end(), round.begin() + 1, round.end());
  const Polyline again = straight(Pose2(Point2(60.5, -1.2), 0.0), 100.0, 0.5);
  points.insert(points.end(), again.begin(), again.end());
  OnLine on(prepared(points, false));
  for (double x = 5.0; x < 59.0; x += 0.5) {
    EXPECT_NEAR(on.at(Pose2(Point2(x, x < 10.0 ? -0.1 : -0.7), 0.0)).s, x, 0.5)
        << "although the other pass is nearer";
  }
}

TEST(Tracker, KnowsTheWayThereFromTheWayBackUpToTheTurn) {
  for (const double spacing : {1.0, 50.0}) {
    Polyline points = straight(Pose2(), 50.0, spacing);
    const Polyline back = straight(Pose2(Point2(50.0 - spacing, 0.0), kPi), 50.0 - spacing, spacing);
    points.insert(points.end(), back.begin(), back.end());
    const NavigationLine line = prepared(points);
    for (const double x : {5.3, 30.4, 49.8}) {
      EXPECT_NEAR(OnLine(line).at(Pose2(Point2(x, 0.1), 0.0)).s, x, 1e-9) << "there";
      EXPECT_NEAR(OnLine(line).at(Pose2(Point2(x, 0.1), kPi)).s, 100.0 - x, 1e-9) << "and back";
      EXPECT_NEAR(OnLine(line).at(Pose2(Point2(x, 0.1), kPi)).heading_offset, 0.0, 1e-9);
    }
  }
}

TEST(Tracker, StaysPutWhereTheVehicleStandsAndItsPoseIsNoisy) {
  OnLine on(prepared_figure_eight());
  const double before = on.at(figure_eight(-0.01), 0.0).s;
  for (int i = 0; i < 50; ++i) {
    const Point2 noise(0.1 * std::sin(3.7 * i), 0.1 * std::cos(2.3 * i));
    const Pose2 pose = figure_eight(-0.01);
    const double s = on.at(Pose2(pose.position() + noise, pose.heading()), 0.0).s;
    EXPECT_NEAR(std::remainder(s - before, on.line().length), 0.0, 0.3);
  }
}

TEST(Tracker, ForgetsItsPlaceWhenReset) {
  const Pose2 start(Point2(15.0, 0.0), kPi / 2.0);
  const NavigationLine ramp = prepared(arc(start, 1.0 / 15.0, 2.0 * 2.0 * kPi * 15.0, 0.5), false);
  const double turn = 2.0 * kPi * 15.0;
  NavigationLineTracker tracker;
  const auto s_at = [&](double s, double seconds) {
    const auto tracked =
        tracker.track(ramp, vehicle_at(test::along_arc(start, 1.0 / 15.0, s), seconds), kMaxDistance);
    return std::get<LineProjection>(tracked).s;
  };
  double seconds = 0.0;
  for (double s = 5.0; s < turn + 20.0; s += 1.0) s_at(s, seconds += 0.1);
  EXPECT_NEAR(s_at(turn + 20.0, seconds += 0.1), turn + 20.0, 0.1) << "on the second turn";
  tracker.reset();
  const double fresh = s_at(turn + 20.0, seconds += 0.1);
  EXPECT_NEAR(std::remainder(fresh - 20.0, turn), 0.0, 0.1) << "on either turn";
}

TEST(Tracker, TakesLinesUpToARightAngleForThoseOfTheVehicle) {
  const NavigationLine line = prepared(straight(Pose2(), 100.0, 1.0));
  OnLine(line).at(Pose2(Point2(50.0, 0.0), 80.0 * kPi / 180.0));
  const LineDrop drop = drop_at(line, Pose2(Point2(50.0, 0.0), 100.0 * kPi / 180.0));
  EXPECT_EQ(drop.code, StatusCode::kOffRoute);
  EXPECT_THAT(drop.reason, HasSubstr("it runs the other way"));
}

TEST(Tracker, LeavesAPassForAnotherThatIsMuchNearer) {
  // Two turns of a coil, 6 m apart: the vehicle drives from the outer to the inner one.
  Polyline coil;
  for (double angle = 0.0; angle <= 4.0 * kPi; angle += 0.01) {
    coil.push_back((40.0 - 6.0 * angle / (2.0 * kPi)) * Point2(std::cos(angle), std::sin(angle)));
  }
  OnLine on(prepared(coil));
  const auto at = [&](double angle, double radius) {
    return on.at(Pose2(radius * Point2(std::cos(angle), std::sin(angle)), angle + 0.5 * kPi)).s;
  };
  double angle = 1.0;
  EXPECT_LT(at(angle, 39.0), 60.0);
  for (double inwards = 0.0; inwards < 6.0; inwards += 0.3) at(angle += 0.02, 39.0 - inwards);
  EXPECT_GT(at(angle += 0.02, 33.0), 200.0);
}

}  // namespace
}  // namespace relative_map::core
