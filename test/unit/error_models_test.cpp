// Over long runs, errors are as large and as frequent as they are asked to be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "relative_map/simulation/localization_errors.hpp"
#include "relative_map/simulation/marker_errors.hpp"
#include "relative_map/simulation/recording_errors.hpp"
#include "relative_map/simulation/road.hpp"

namespace relative_map::core {
namespace {

/// Mean of a * b.
double correlation(const std::vector<double>& values, std::size_t lag) {
  double sum = 0.0;
  for (std::size_t i = lag; i < values.size(); ++i) sum += values[i] * values[i - lag];
  return sum / static_cast<double>(values.size() - lag);
}

double rms(const std::vector<double>& values) {
  return std::sqrt(correlation(values, 0));
}

std::vector<double> sampled(const std::function<double(double)>& at, std::size_t count, double step) {
  std::vector<double> values;
  for (std::size_t i = 0; i < count; ++i) values.push_back(at(step * static_cast<double>(i)));
  return values;
}

TEST(OrnsteinUhlenbeck, HasItsSizeAndItsTimeConstant) {
  OrnsteinUhlenbeck process(0.3, 30.0, NoiseSource(5, 1));
  const std::vector<double> values = sampled([&](double t) { return process.at(t); }, 200000, 1.0);
  EXPECT_NEAR(rms(values), 0.3, 0.015);
  const double variance = correlation(values, 0);
  EXPECT_NEAR(correlation(values, 30) / variance, std::exp(-1.0), 0.05);
  EXPECT_NEAR(correlation(values, 90) / variance, std::exp(-3.0), 0.05);
}

TEST(OrnsteinUhlenbeck, IsTheSameSizeFromTheFirstMomentOnAndHoweverOftenItIsAsked) {
  std::vector<double> first, later, change;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    OrnsteinUhlenbeck process(2.0, 5.0, NoiseSource(seed, 1));
    first.push_back(process.at(0.0));
    for (double t = 0.1; t < 4.95; t += 0.1) process.at(t);
    later.push_back(process.at(5.0));
    change.push_back(later.back() - std::exp(-1.0) * first.back());
  }
  EXPECT_NEAR(rms(first), 2.0, 0.1);
  EXPECT_NEAR(rms(later), 2.0, 0.1);
  EXPECT_NEAR(rms(change), 2.0 * std::sqrt(1.0 - std::exp(-2.0)), 0.1);
}

TEST(SmoothRandom, HasItsSizeAndItsLength) {
  std::vector<double> here, near, far;
  for (std::uint64_t seed = 1; seed <= 4000; ++seed) {
    const SmoothRandom random(0.1, 60.0, 0.0, seed, 3);
    here.push_back(random.at(1000.0));
    near.push_back(random.at(1060.0) * here.back());
    far.push_back(random.at(1300.0) * here.back());
  }
  const auto mean = [](const std::vector<double>& values) {
    double sum = 0.0;
    for (const double value : values) sum += value;
    return sum / static_cast<double>(values.size());
  };
  EXPECT_NEAR(rms(here), 0.1, 0.005);
  EXPECT_NEAR(mean(near) / 0.01, std::exp(-0.5), 0.06);
  EXPECT_NEAR(mean(far) / 0.01, 0.0, 0.06);
}

TEST(SmoothRandom, MeetsItselfAfterALap) {
  const SmoothRandom random(0.1, 60.0, 757.0, 9, 3);
  for (double s = 0.0; s < 757.0; s += 50.0) EXPECT_NEAR(random.at(s), random.at(s + 757.0), 1e-9);
  EXPECT_GT(std::abs(random.at(100.0) - random.at(200.0)), 1e-3);
}

TEST(Episodes, AreAsFrequentAndAsLongAsAskedFor) {
  Episodes episodes({10.0, 0.5, 1.5}, 4, 1);
  const double step = 0.05, end = 50000.0;
  double going_on = 0.0, both = 0.0, left = 0.0, start = -1.0;
  int count = 0;
  for (double t = 0.0; t < end; t += step) {
    const Episode* episode = episodes.at(t);
    if (episode == nullptr) continue;
    going_on += step;
    if (episode->start == start) continue;
    start = episode->start;
    ++count;
    EXPECT_TRUE(episode->left || episode->right);
    EXPECT_GE(episode->end - episode->start, 0.5 - 1e-9);
    EXPECT_LE(episode->end - episode->start, 1.5 + 1e-9);
    EXPECT_LE(std::abs(episode->size), 1.0);
    if (episode->left && episode->right) ++both;
    if (episode->left && !episode->right) ++left;
  }
  EXPECT_NEAR(count, end / 11.0, 0.05 * end / 11.0);
  EXPECT_NEAR(going_on, end / 11.0, 0.05 * end / 11.0);
  EXPECT_NEAR(both / count, 0.2, 0.03);
  EXPECT_NEAR(left / count, 0.4, 0.03);
}

TEST(Episodes, AreNoneWithoutAnInterval) {
  Episodes episodes({0.0, 0.5, 1.5}, 4, 1);
  for (double t = 0.0; t < 1000.0; t += 1.0) EXPECT_EQ(episodes.at(t), nullptr);
}

TEST(LocalizationErrors, AreNoneByDefault) {
  LocalizationErrors errors({}, 3);
  EXPECT_EQ(errors.position_bias(0.0), Point2(0.0, 0.0));
  EXPECT_EQ(errors.position_bias(50.0), Point2(0.0, 0.0));
  EXPECT_EQ(errors.heading_bias(50.0), 0.0);
  EXPECT_EQ(errors.yaw_rate_bias(), 0.0);
}

TEST(LocalizationErrors, BiasesHaveTheirSizes) {
  LocalizationErrorParam param;
  param.bias = 0.3;
  param.heading_bias = 0.005;
  LocalizationErrors errors(param, 3);
  std::vector<double> x, y, heading;
  for (double t = 0.0; t < 200000.0; t += 3.0) {
    const Point2 bias = errors.position_bias(t);
    x.push_back(bias.x());
    y.push_back(bias.y());
    heading.push_back(errors.heading_bias(t));
  }
  EXPECT_NEAR(rms(x), 0.3, 0.02);
  EXPECT_NEAR(rms(y), 0.3, 0.02);
  EXPECT_NEAR(rms(heading), 0.005, 0.0003);
  EXPECT_NEAR(correlation(x, 10) / correlation(x, 0), std::exp(-1.0), 0.05);
}

TEST(LocalizationErrors, DriftGrowsSmoothlyToItsSizeAndStays) {
  LocalizationErrorParam param;
  param.drift = 12.0;
  param.drift_time = 100.0;
  std::vector<double> directions;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    LocalizationErrors errors(param, seed);
    Point2 before = errors.position_bias(0.0);
    EXPECT_EQ(before.norm(), 0.0);
    double fastest = 0.0;
    for (double t = 0.1; t < 99.95; t += 0.1) {
      const Point2 now = errors.position_bias(t);
      fastest = std::max(fastest, (now - before).norm() / 0.1);
      before = now;
    }
    EXPECT_GT(fastest, 0.12);
    EXPECT_LT(fastest, 0.35);  // [m/s]
    const Point2 end = errors.position_bias(100.0);
    EXPECT_GT(end.norm(), 9.0);
    EXPECT_LT(end.norm(), 15.0);
    EXPECT_EQ(errors.position_bias(500.0), end);
    directions.push_back(std::atan2(end.y(), end.x()));
  }
  EXPECT_GT(*std::max_element(directions.begin(), directions.end()), 1.5);
  EXPECT_LT(*std::min_element(directions.begin(), directions.end()), -1.5);
}

TEST(LocalizationErrors, YawRateBiasIsWithinItsLimit) {
  LocalizationErrorParam param;
  param.yaw_rate_bias = 0.002;
  double largest = 0.0, sum = 0.0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const double bias = LocalizationErrors(param, seed).yaw_rate_bias();
    largest = std::max(largest, std::abs(bias));
    sum += bias;
  }
  EXPECT_LE(largest, 0.002);
  EXPECT_GT(largest, 0.0018);
  EXPECT_NEAR(sum / 500.0, 0.0, 0.0003);
}

TEST(LocalizationErrors, AJumpLastsAsLongAndIsAsFarAsAskedFor) {
  LocalizationErrorParam param;
  param.jump = {20.0, 5.0, 15.0};
  param.min_jump = 0.5;
  param.max_jump = 4.0;
  LocalizationErrors errors(param, 3);
  int jumps = 0;
  double since = 0.0;
  Point2 last = Point2::Zero();
  for (double t = 0.0; t < 20000.0; t += 0.1) {
    const Point2 bias = errors.position_bias(t);
    if (bias == last) continue;
    const bool away = last == Point2::Zero();
    if (away) {
      ++jumps;
      EXPECT_GE(bias.norm(), 0.5);
      EXPECT_LE(bias.norm(), 4.0);
    } else {
      EXPECT_EQ(bias, Point2(Point2::Zero()));
      EXPECT_GE(t - since, 4.9);
      EXPECT_LE(t - since, 15.2);
    }
    since = t;
    last = bias;
  }
  EXPECT_NEAR(jumps, 20000.0 / 30.0, 80.0);
}

/// The vehicle drives 100 m at 10 m/s, turns left on the spot of a corner, and drives 100 m again.
Pose2 at_corner(double time) {
  const double way = 10.0 * time;
  if (way <= 100.0) return {Point2(way, 0.0), 0.0};
  return {Point2(100.0, way - 100.0), 0.5 * kPi};
}

TEST(PoseDrift, IsWhatItsSensorsAreWrongBy) {
  PoseDriftParam param;
  param.dead_reckoned = true;
  PoseDrift drift(param, 1.02, 1.01, 0.001, 1);
  Pose2 seeming;
  for (int i = 0; i <= 2000; ++i) seeming = drift.at(at_corner(0.01 * i), 0.01 * i);
  EXPECT_NEAR(seeming.heading(), 0.5 * kPi * 1.01 + 0.001 * 20.0, 1e-6);
  EXPECT_NEAR(seeming.position().norm(), 1.02 * std::sqrt(2.0) * 100.0, 2.0);
  EXPECT_LT(seeming.position().x(), 102.0 - 100.0 * 0.015) << "it has turned too far";
  drift.restart();
  EXPECT_EQ(drift.at(Pose2(), 21.0).position(), Point2(Point2::Zero()));
}

TEST(PoseDrift, WalksWithTheRootOfTheWay) {
  PoseDriftParam param;
  param.heading_walk = 0.002;
  std::vector<double> headings;
  for (std::uint64_t seed = 1; seed <= 1000; ++seed) {
    PoseDrift drift(param, 1.0, 1.0, 0.0, seed);
    Pose2 seeming;
    for (int i = 0; i <= 100; ++i) seeming = drift.at(Pose2(Point2(4.0 * i, 0.0), 0.0), 0.1 * i);
    headings.push_back(seeming.heading());
  }
  EXPECT_NEAR(rms(headings), 0.002 * std::sqrt(400.0), 0.003);
}

TEST(RecordLine, WithoutErrorsIsTheTruth) {
  const RecordedLine truth = demo_road().lane(0.0, 0.5);
  const RecordedLine recorded = record_line(truth, {}, 1);
  ASSERT_EQ(recorded.points.size(), truth.points.size());
  EXPECT_EQ(recorded.points[700].x, truth.points[700].x);
  EXPECT_EQ(recorded.points[700].theta, truth.points[700].theta);
}

/// [m] of each point to the left of the truth.
std::vector<double> offsets(const RecordedLine& truth, const RecordedLine& recorded) {
  std::vector<double> values;
  for (std::size_t i = 0; i < truth.points.size(); ++i) {
    const LinePoint &a = truth.points[i], &b = recorded.points[i];
    const Point2 apart(b.x - a.x, b.y - a.y), ahead(std::cos(a.theta), std::sin(a.theta));
    EXPECT_NEAR(ahead.dot(apart), 0.0, 5e-3);
    values.push_back(cross(ahead, apart));
  }
  return values;
}

TEST(RecordLine, IsAsideByWhatItIsAskedToBe) {
  const RecordedLine truth = demo_road().lane(0.0, 0.5, "a");
  RecordingErrorParam param;
  param.offset = 0.15;
  std::vector<double> means, swings;
  for (std::uint64_t seed = 1; seed <= 100; ++seed) {
    const RecordedLine recorded = record_line(truth, param, seed);
    EXPECT_EQ(recorded.name, "a");
    EXPECT_TRUE(std::isnan(recorded.points[5].theta));
    const std::vector<double> constant = offsets(truth, recorded);
    EXPECT_NEAR(constant.front(), constant.back(), 1e-6);
    means.push_back(constant.front());
  }
  EXPECT_NEAR(rms(means), 0.15, 0.03);

  param.offset = 0.0;
  param.wander = 0.1;
  for (std::uint64_t seed = 1; seed <= 30; ++seed) {
    const std::vector<double> swing = offsets(truth, record_line(truth, param, seed));
    swings.insert(swings.end(), swing.begin(), swing.end());
    for (std::size_t i = 1; i < swing.size(); ++i) EXPECT_LT(std::abs(swing[i] - swing[i - 1]), 0.006);
  }
  EXPECT_NEAR(rms(swings), 0.1, 0.015);
}

TEST(ErrorParam, FaultsAreNamed) {
  ErrorParam param;
  EXPECT_TRUE(param.validate().empty());
  param.localization.bias_time = 0.0;
  param.markers.max_jump = 1.0;
  param.markers.outlier.interval = std::nan("");
  const std::vector<std::string> faults = param.validate();
  ASSERT_EQ(faults.size(), 3u);
  EXPECT_EQ(faults[0], "errors/localization_bias_time is 0, but must lie in [0.01, 1e+06]");
  EXPECT_EQ(faults[1].find("errors/outlier_interval is nan"), 0u);
  EXPECT_EQ(faults[2], "errors/max_jump is 1, but must lie in [1.5, 100]");
}

}  // namespace
}  // namespace relative_map::core
