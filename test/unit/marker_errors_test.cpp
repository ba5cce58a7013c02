#include "relative_map/simulation/marker_errors.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "relative_map/simulation/accuracy_scenes.hpp"
#include "support/markers.hpp"

namespace relative_map::core {
namespace {

constexpr double kImage = 0.08;  // [s] between two

LaneMarkers true_markers() {
  LaneMarkers markers = test::lane_about(Cubic());
  markers.next_left.push_back(test::marker({5.25, 0.0, 0.0, 0.0}));
  markers.next_right.push_back(test::marker({-5.25, 0.0, 0.0, 0.0}));
  return markers;
}

double rms(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

TEST(MarkerErrors, AreNoneByDefault) {
  MarkerErrors errors({}, {}, 1);
  for (int i = 0; i < 1000; ++i) {
    LaneMarkers markers = true_markers();
    EXPECT_EQ(errors.view_range(50.0, kImage * i), 50.0);
    errors.spoil(markers, kImage * i);
    EXPECT_EQ(markers.left.cubic.c0, 1.75);
    EXPECT_EQ(markers.right.cubic.c3, 0.0);
    EXPECT_EQ(markers.right.quality, 0.9);
    EXPECT_EQ(errors.draw_latency(), 0.0);
  }
}

/// [m] errors of the left marker, image by image.
std::vector<double> errors_at(double x, const MarkerErrorParam& param, const CubicNoise& noise,
                              std::uint64_t seed, int images) {
  MarkerErrors errors(param, noise, seed);
  std::vector<double> values;
  for (int i = 0; i < images; ++i) {
    LaneMarkers markers = true_markers();
    errors.spoil(markers, kImage * i);
    values.push_back(markers.left.cubic.value(x) - 1.75);
  }
  return values;
}

TEST(MarkerErrors, NoiseGrowsWithDistanceToAQuarterOfAMetre) {
  VehicleSimulationConfig config;
  set_usual_errors(config);
  const NoiseParam& usual = config.noise;
  const CubicNoise noise{usual.marker_c0, usual.marker_c1, usual.marker_c2, usual.marker_c3};
  MarkerErrorParam param;
  param.correlated_share = config.errors.markers.correlated_share;
  EXPECT_NEAR(rms(errors_at(0.0, param, noise, 1, 40000)), 0.03, 0.002);
  EXPECT_NEAR(rms(errors_at(10.0, param, noise, 1, 40000)), 0.043, 0.003);
  EXPECT_NEAR(rms(errors_at(50.0, param, noise, 1, 40000)), 0.25, 0.02);
}

TEST(MarkerErrors, OfTheNoiseAShareLasts) {
  MarkerErrorParam param;
  const auto kept = [&](double share, std::size_t images) {
    param.correlated_share = share;
    const std::vector<double> values = errors_at(0.0, param, {0.03, 0.0, 0.0, 0.0}, 2, 60000);
    double sum = 0.0;
    for (std::size_t i = images; i < values.size(); ++i) sum += values[i] * values[i - images];
    return sum / static_cast<double>(values.size() - images) / (0.03 * 0.03);
  };
  EXPECT_NEAR(kept(0.5, 1), 0.5 * std::exp(-kImage), 0.03);
  EXPECT_NEAR(kept(0.5, 12), 0.5 * std::exp(-12.0 * kImage), 0.03);
  EXPECT_NEAR(kept(0.0, 1), 0.0, 0.03);
  EXPECT_NEAR(kept(1.0, 1), std::exp(-kImage), 0.03);
}

TEST(MarkerErrors, OfTheNoiseAShareIsCommonToAllPaint) {
  MarkerErrorParam param;
  param.common_share = 0.7;
  MarkerErrors errors(param, {0.03, 0.0, 0.0, 0.0}, 2);
  std::vector<double> left;
  double product = 0.0;
  for (int i = 0; i < 40000; ++i) {
    LaneMarkers markers = true_markers();
    errors.spoil(markers, kImage * i);
    left.push_back(markers.left.cubic.c0 - 1.75);
    product += left.back() * (markers.right.cubic.c0 + 1.75) / 40000.0;
  }
  EXPECT_NEAR(rms(left), 0.03, 0.001);
  EXPECT_NEAR(product / (0.03 * 0.03), 0.7, 0.03);
}

TEST(MarkerErrors, ViewRangeChangesSlowlyWithinItsLimits) {
  MarkerErrorParam param;
  param.view_range_change = 12.0;
  MarkerErrors errors(param, {}, 1);
  double shortest = 1e9, longest = 0.0, before = errors.view_range(50.0, 0.0), steps = 0.0;
  const int images = 50000;
  for (int i = 1; i < images; ++i) {
    const double range = errors.view_range(50.0, kImage * i);
    shortest = std::min(shortest, range);
    longest = std::max(longest, range);
    steps += std::abs(range - before);
    before = range;
  }
  EXPECT_EQ(shortest, 25.0);
  EXPECT_EQ(longest, 70.0);
  EXPECT_LT(steps / images, 2.0);
}

TEST(MarkerErrors, DropoutsAndOutliersHappenAsOftenAsAskedFor) {
  MarkerErrorParam param;
  param.dropout.interval = 12.0;  // 0.2 to 3 s long
  param.outlier.interval = 10.0;  // 0.1 to 1 s
  MarkerErrors errors(param, {}, 7);
  const int images = 500000;
  int left_gone = 0, right_gone = 0, both_gone = 0, next_gone = 0, off = 0, off_of = 0;
  for (int i = 0; i < images; ++i) {
    LaneMarkers markers = true_markers();
    errors.spoil(markers, kImage * i);
    const bool left = markers.left.quality > 0.0, right = markers.right.quality > 0.0;
    if (!left) ++left_gone;
    if (!right) ++right_gone;
    if (!left && !right) ++both_gone;
    if (markers.next_left.empty()) ++next_gone;
    if (!left) {
      EXPECT_EQ(markers.left.view_range, 0.0);
      continue;
    }
    ++off_of;
    const double jump = std::abs(markers.left.cubic.c0 - 1.75);
    if (jump == 0.0) continue;
    ++off;
    EXPECT_GE(jump, 1.5);
    EXPECT_LE(jump, 3.5);
    EXPECT_EQ(markers.left.quality, 0.9);
  }
  const double dropped = 1.6 / 13.6, jumped = 0.55 / 10.55;  // of the time
  EXPECT_NEAR(left_gone / static_cast<double>(images), 0.6 * dropped, 0.1 * dropped);
  EXPECT_NEAR(right_gone / static_cast<double>(images), 0.6 * dropped, 0.1 * dropped);
  EXPECT_NEAR(both_gone / static_cast<double>(images), 0.2 * dropped, 0.1 * dropped);
  EXPECT_EQ(next_gone, left_gone);
  EXPECT_NEAR(off / static_cast<double>(off_of), 0.6 * jumped, 0.1 * jumped);
}

TEST(MarkerErrors, LatencyIsWithinItsLimits) {
  MarkerErrorParam param;
  param.min_latency = 0.05;
  param.max_latency = 0.15;
  MarkerErrors errors(param, {}, 1);
  double least = 1.0, most = 0.0, sum = 0.0;
  for (int i = 0; i < 2000; ++i) {
    const double latency = errors.draw_latency();
    least = std::min(least, latency);
    most = std::max(most, latency);
    sum += latency;
  }
  EXPECT_GE(least, 0.05);
  EXPECT_LE(most, 0.15);
  EXPECT_NEAR(sum / 2000.0, 0.1, 0.002);
}

TEST(MarkerErrors, TheSameSeedGivesTheSameErrors) {
  MarkerErrorParam param;
  param.correlated_share = 0.5;
  param.outlier.interval = 1.0;
  const CubicNoise noise{0.03, 0.003, 6e-5, 1e-6};
  EXPECT_EQ(errors_at(20.0, param, noise, 3, 200), errors_at(20.0, param, noise, 3, 200));
  EXPECT_NE(errors_at(20.0, param, noise, 3, 200), errors_at(20.0, param, noise, 4, 200));
}

}  // namespace
}  // namespace relative_map::core
