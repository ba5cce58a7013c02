// The filter's Jacobians against numerical ones, and its claims against its own errors.

#include "relative_map/pipeline/estimation/lane_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <random>

#include "support/markers.hpp"
#include "support/vehicles.hpp"

namespace relative_map::core {
namespace {

using State = LaneFilter::State;
using Column = Eigen::Matrix<double, LaneFilter::kStates, 1>;

constexpr double kNever = 1e9;  // [s]

/// Moves one state by `by`, and takes e e' out of its covariance: a measurement that wants just that.
void nudge(LaneFilter& filter, int state, double by) {
  LaneFilter::Measurement wish;
  wish.innovation.setZero();
  wish.innovation[0] = by;
  wish.expected.cross.setZero();
  wish.expected.cross(state, 0) = 1.0;
  wish.expected.covariance.setIdentity();
  filter.correct(wish);
}

/// On a bend of 80 m radius, off its line and turned from it.
struct OnABend {
  NavigationLine line = test::prepared(test::arc(Pose2(), 1.0 / 80.0, 150.0, 0.5));
  VehicleState vehicle =
      test::vehicle_at(test::along_arc(Pose2(), 1.0 / 80.0, 30.0).to_parent(Pose2(Point2(0.0, 0.4), 0.03)));

  LaneFilter filter() const {
    LaneFilter filter(SensorNoise(), vehicle, 1.7, 0.2);
    filter.follow(line, 30.0);
    return filter;
  }
  PaintTerms innovation(const LaneFilter& filter, const PaintSamples& paint, LaneFilter::Side side) const {
    return filter.measure(paint, side, line, 60, 1.0)->innovation;
  }
};

TEST(LaneFilter, JacobiansOfPaintAreThoseOfItsModel) {
  const OnABend bend;
  const LaneFilter filter = bend.filter();
  for (const auto side : {LaneFilter::Side::kLeft, LaneFilter::Side::kRight}) {
    const double sign = side == LaneFilter::Side::kLeft ? 1.0 : -1.0;
    const PaintSamples paint =
        sample_paint(test::marker({1.7 * sign - 0.4, -0.03, 0.00625, 0.0}, 35.0), Pose2(), CameraNoise());
    const auto measurement = filter.measure(paint, side, bend.line, 60, 1.0);
    ASSERT_TRUE(measurement);
    for (int state = LaneFilter::kX; state < LaneFilter::kStates; ++state) {
      constexpr double kStep = 1e-4;
      LaneFilter more = filter, less = filter;
      nudge(more, state, kStep);
      nudge(less, state, -kStep);
      const PaintTerms slope =
          (bend.innovation(more, paint, side) - bend.innovation(less, paint, side)) / (2.0 * kStep);
      // How the line turns beside what is left over is no part of the model.
      EXPECT_LT((slope + measurement->jacobian.col(state)).norm(), 0.04 * (1.0 + slope.norm())) << state;
    }
  }
}

TEST(LaneFilter, MovesItsCovarianceByTheJacobianOfItsMotion) {
  const OnABend bend;
  VehicleState from = bend.vehicle, to = bend.vehicle;
  to.stamp = from.stamp + from_seconds(0.1);
  from.yaw_rate = to.yaw_rate = 0.12;
  const auto moved = [&](LaneFilter filter) {
    filter.move(from, to, 0.1, kNever, false);
    return filter;
  };
  const LaneFilter filter = bend.filter(), after = moved(filter);
  for (int state = 0; state < LaneFilter::kFirstKnot; ++state) {
    constexpr double kStep = 1e-5;
    LaneFilter same = filter, more = filter, less = filter;
    nudge(same, state, 0.0);
    nudge(more, state, kStep);
    nudge(less, state, -kStep);
    const Column numerical = (moved(more).state() - moved(less).state()) / (2.0 * kStep);
    const auto lost = after.covariance() - moved(same).covariance();
    EXPECT_LT((lost - numerical * numerical.transpose()).cwiseAbs().maxCoeff(), 2e-4) << state;
  }
}

/// A lane beside a line, a vehicle in its middle, and sensors whose errors are drawn from what the filter
/// assumes of them.
class DrawnDrive {
 public:
  explicit DrawnDrive(unsigned seed) : random_(seed) {
    const SensorNoise noise;
    bias_ = Pose2(Point2(draw(noise.localization.position_bias), draw(noise.localization.position_bias)),
                  draw(noise.localization.heading_bias));
    yaw_rate_bias_ = draw(noise.odometry.yaw_rate_bias);
    speed_scale_ = draw(noise.odometry.speed_scale);
    camera_ = Pose2(Point2(0.0, draw(noise.camera.mount_offset)), draw(noise.camera.mount_yaw));
    half_width_ = 1.75 + draw(0.2);
    recording_ = draw(noise.road.recording);
  }

  /// [-] the error of the vehicle's place in its lane after some seconds, in claimed standard deviations.
  double drive() {
    VehicleState last = localized(0.0);
    LaneFilter filter(SensorNoise(), last, 1.75, 0.2);
    for (int tick = 1; tick <= kTicks; ++tick) {
      const double seconds = kStep * tick;
      const VehicleState now = localized(seconds);
      filter.move(last, now, 0.02, kNever, false);
      filter.localize(now, 0.02, 0.003);
      last = now;
      filter.follow(line_, kSpeed * seconds * radius(0.0) / radius(recording_));
      if (tick % 2 != 0) continue;
      for (const auto side : {LaneFilter::Side::kLeft, LaneFilter::Side::kRight}) {
        const auto paint = filter.measure(seen(side), side, line_, vertex(seconds), 1.0);
        if (paint) filter.correct(*paint);
      }
    }
    const double seconds = kStep * kTicks;
    LineWalker walker(line_, vertex(seconds));
    const BesideLine beside = walker.beside(filter.pose().position() - line_.origin);
    const double place = beside.lateral - filter.offsets().at(filter.knots_at(line_, beside.s));
    return place / filter.lateral(beside.normal).stddev;
  }

 private:
  static constexpr double kSpeed = 12.0, kStep = 0.05, kKappa = 1.0 / 150.0;
  static constexpr int kTicks = 100;

  double draw(double stddev) { return stddev * normal_(random_); }
  /// [m] of what is `left` of the line: it bends to the left.
  static double radius(double left) { return 1.0 / kKappa - left; }
  static std::size_t vertex(double seconds) { return static_cast<std::size_t>(kSpeed * seconds / 0.5); }

  VehicleState localized(double seconds) {
    const double turn = kSpeed * seconds / radius(recording_);
    const Point2 center(0.0, radius(0.0));
    const Pose2 pose(center + radius(recording_) * Point2(std::sin(turn), -std::cos(turn)), turn);
    VehicleState state =
        test::vehicle_at(Pose2(pose.position() + bias_.position() + Point2(draw(0.02), draw(0.02)),
                               pose.heading() + bias_.heading() + draw(0.003)),
                         seconds, kSpeed / (1.0 + speed_scale_));
    state.yaw_rate = kSpeed / radius(recording_) + yaw_rate_bias_;
    return state;
  }

  /// A cubic by least squares through the border, in the frame of a camera that is off its mounting.
  PaintSamples seen(LaneFilter::Side side) {
    constexpr double kRange = 40.0;
    const double border = radius(recording_ + (side == LaneFilter::Side::kLeft ? half_width_ : -half_width_));
    const Pose2 base_from_camera(camera_.rotate_to_parent(camera_.position()), camera_.heading());
    const Point2 center = base_from_camera.to_local(Point2(0.0, radius(recording_)));
    SampleValues values;
    for (int i = 0; i < kPaintSamples; ++i) {
      const double x = kRange * i / (kPaintSamples - 1) - center.x();
      values[i] = center.y() - std::sqrt(border * border - x * x);
    }
    PaintTerms terms = least_squares(3, kPaintSamples) * values;
    const Eigen::Matrix4d covariance =
        sample_paint(test::marker({0.0, 0.0, 1e-3, 0.0}, kRange, 1.0), Pose2(), CameraNoise()).covariance;
    PaintTerms noise;
    for (int i = 0; i < kPaintTerms; ++i) noise[i] = draw(1.0);
    terms += covariance.llt().matrixL() * noise;
    const Cubic cubic{terms[0], terms[1] / kRange, terms[2] / (kRange * kRange),
                      terms[3] / (kRange * kRange * kRange)};
    return sample_paint(test::marker(cubic, kRange, 1.0), Pose2(), CameraNoise());
  }

  std::mt19937 random_;
  std::normal_distribution<double> normal_;
  NavigationLine line_ = test::prepared(test::arc(Pose2(), kKappa, 200.0, 0.5));
  Pose2 bias_, camera_;
  double yaw_rate_bias_ = 0.0, speed_scale_ = 0.0, half_width_ = 1.75, recording_ = 0.0;
};

// The normalized estimation error squared of one number is 1 on average (Bar-Shalom, Li and Kirubarajan 2001,
// chapter 5), and less where the filter is ready for changes that do not come here.
TEST(LaneFilter, ErrorsAreWhatItClaims) {
  constexpr unsigned kDrives = 100;
  double squares = 0.0;
  unsigned beyond_three = 0;
  for (unsigned seed = 1; seed <= kDrives; ++seed) {
    const double error = DrawnDrive(seed).drive();
    squares += error * error;
    beyond_three += std::abs(error) > 3.0 ? 1 : 0;
  }
  EXPECT_LT(squares / kDrives, 1.2);
  EXPECT_GT(squares / kDrives, 0.2) << "it claims far too little";
  EXPECT_LE(beyond_three, 1u);
}

TEST(LaneFilter, AJumpBecomesBiasAndTheVehicleStays) {
  const OnABend bend;
  LaneFilter filter = bend.filter();
  for (int i = 0; i < 50; ++i) filter.localize(bend.vehicle, 0.02, 0.003);
  const Point2 before = filter.pose().position();
  VehicleState jumped = bend.vehicle;
  jumped.map_from_base =
      Pose2(jumped.map_from_base.position() + Point2(6.0, -8.0), jumped.map_from_base.heading());
  filter.localize(jumped, 0.02, 0.003);
  EXPECT_LT((filter.pose().position() - before).norm(), 0.5);
  EXPECT_NEAR(filter.state()[LaneFilter::kBiasX], 6.0, 0.5);
  EXPECT_NEAR(filter.state()[LaneFilter::kBiasY], -8.0, 0.5);
}

TEST(LaneFilter, AShiftMovesTheVehicleAndNotWhereLocalizationHasIt) {
  const OnABend bend;
  LaneFilter filter = bend.filter();
  const auto localized = [&] {
    return Point2(filter.state()[LaneFilter::kX] + filter.state()[LaneFilter::kBiasX],
                  filter.state()[LaneFilter::kY] + filter.state()[LaneFilter::kBiasY]);
  };
  const Point2 before = localized(), place = filter.pose().position();
  filter.shift(Point2(0.6, 0.8), 3.5, 0.3);
  EXPECT_NEAR((localized() - before).norm(), 0.0, 1e-12);
  EXPECT_NEAR((filter.pose().position() - place).norm(), 3.5, 1e-12);
  EXPECT_TRUE(filter.sound());
}

TEST(LaneFilter, OnAnotherLineOffsetsAreUnknownAgain) {
  const OnABend bend;
  LaneFilter filter = bend.filter();
  nudge(filter, LaneFilter::kRecording, 0.5);
  nudge(filter, LaneFilter::kFirstKnot + 2, 0.5);
  NavigationLine other = bend.line;
  other.id = "another";
  filter.follow(other, 30.0);
  EXPECT_EQ(filter.state()[LaneFilter::kRecording], 0.0);
  EXPECT_EQ(filter.state().tail<OffsetProfile::kKnots>().norm(), 0.0);
  EXPECT_EQ(filter.line_id(), "another");
}

}  // namespace
}  // namespace relative_map::core
