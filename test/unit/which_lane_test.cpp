#include "relative_map/pipeline/estimation/which_lane.hpp"

#include <gtest/gtest.h>

namespace relative_map::core {
namespace {

using Seen = WhichLane::Seen;

constexpr double kHalf = 1.75;  // [m] of each lane

WhichLane::Road road_of(const std::vector<double>& centers) {
  return {centers, kHalf, 0.35};
}

/// `seconds` of images of a lane whose center is `center` [m] to the left of the vehicle.
void see(WhichLane& lane, double center, double seconds, const WhichLane::Road& road, bool left = true,
         bool right = true) {
  const auto side = [&](double offset, bool there) {
    return there ? std::optional<Seen>(Seen{center + offset, 0.1}) : std::nullopt;
  };
  for (double t = 0.0; t < seconds; t += 0.1) {
    lane.see(side(kHalf, left), side(-kHalf, right), 0.1, road);
    lane.move(0.0, 0.03, 0.0);
  }
}

TEST(WhichLane, BeginsInALaneAndNotBetweenTwo) {
  const WhichLane::Road road = road_of({0.0, 3.5});
  WhichLane lane(1.5);
  lane.start(road, 0.8);
  EXPECT_NEAR(lane.likeliest().offset, 0.0, 0.3);
  lane.start(road, 2.9);
  EXPECT_NEAR(lane.likeliest().offset, 3.5, 0.3);
}

TEST(WhichLane, OneLineIsTheLaneThatIsDrivenInHoweverFarOffLocalizationIs) {
  for (const double localized : {-8.0, -3.0, 1.7, 4.0, 9.0}) {
    const WhichLane::Road road = road_of({0.0});
    WhichLane lane(1.5);
    lane.start(road, localized);
    see(lane, 0.0, 4.0, road);
    EXPECT_NEAR(lane.likeliest().offset, 0.0, 0.3) << localized;
    EXPECT_GT(lane.likeliest().share, 0.8) << localized;
  }
}

TEST(WhichLane, BothSidesDecideWithinTwoSecondsAndOneWithinFour) {
  const WhichLane::Road road = road_of({0.0});
  for (const bool right : {true, false}) {
    WhichLane lane(1.5);
    lane.start(road, 1.5);
    see(lane, -0.4, right ? 2.0 : 4.0, road, true, right);
    EXPECT_NEAR(lane.likeliest().offset, 0.4, 0.4);
    EXPECT_GT(lane.likeliest().share, 0.8);
  }
}

TEST(WhichLane, BetweenTwoLanesOnlyTheNameIsOpen) {
  const WhichLane::Road road = road_of({-1.75, 1.75});
  WhichLane lane(1.5);
  lane.start(road, 0.0);
  see(lane, 0.0, 3.0, road);  // the vehicle is in the middle of one of them
  const WhichLane::Place place = lane.likeliest();
  EXPECT_LT(place.share, 0.8);
  EXPECT_GT(lane.share_alike(place, road), 0.9);
  EXPECT_NEAR(std::abs(place.offset), 1.75, 0.3);
}

TEST(WhichLane, AnOutlierIsForgottenWithThePaintThatFollows) {
  const WhichLane::Road road = road_of({0.0});
  WhichLane lane(1.5);
  lane.start(road, 0.0);
  see(lane, 0.0, 3.0, road);
  see(lane, -1.4, 0.5, road);
  EXPECT_NEAR(lane.likeliest().offset, 0.0, 0.5);
  see(lane, 0.0, 1.0, road);
  EXPECT_NEAR(lane.likeliest().offset, 0.0, 0.2);
}

TEST(WhichLane, AJumpOfLocalizationIsNoLaneChangeAndOdometryIsOne) {
  const WhichLane::Road road = road_of({0.0, 3.5});
  WhichLane lane(1.5);
  lane.start(road, 0.0);
  see(lane, 0.0, 2.0, road);
  lane.move(0.0, 0.05, 3.5);
  EXPECT_NEAR(lane.likeliest().offset, 0.0, 0.3);
  for (int i = 0; i < 35; ++i) lane.move(0.1, 0.03, 3.5);
  see(lane, 0.0, 1.0, road);
  EXPECT_NEAR(lane.likeliest().offset, 3.5, 0.3);
}

TEST(WhichLane, NumbersThatAreNoneAndLeapsChangeNothing) {
  const WhichLane::Road road = road_of({0.0});
  WhichLane lane(1.5);
  lane.start(road, std::nan(""));
  see(lane, 0.0, 2.0, road);
  const WhichLane::Place before = lane.likeliest();
  lane.move(std::nan(""), 0.1, std::nan(""));
  lane.move(1e6, 0.1, 0.0);
  lane.move(0.1, std::nan(""), 0.0);
  EXPECT_EQ(lane.likeliest().offset, before.offset);
  EXPECT_EQ(lane.likeliest().share, before.share);
}

}  // namespace
}  // namespace relative_map::core
