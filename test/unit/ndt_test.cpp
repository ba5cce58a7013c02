// Normal distributions transform: constants, derivatives, search, covariance and belief.
#include <gmock/gmock.h>

#include <random>

#include "relative_map/localization/clouds/cloud_filters.hpp"
#include "relative_map/localization/ndt/line_search.hpp"
#include "relative_map/localization/ndt/ndt_belief.hpp"
#include "relative_map/localization/ndt/ndt_matcher.hpp"
#include "support/lidar_rooms.hpp"

namespace relative_map::core {
namespace {

using test::corridor;
using test::pose;
using test::yard;
using testing::ElementsAre;
using testing::HasSubstr;

TEST(NdtMixtureTest, IsMagnussons) {
  for (const double resolution : {0.5, 1.0, 2.0, 4.0}) {
    const NdtMixture mixture(resolution);
    const double c1 = 4.5, c2 = 0.55 / std::pow(resolution, 3);
    const auto exact = [&](double q) { return -std::log(c1 * std::exp(-0.5 * q) + c2); };
    // The approximation d1 exp(-d2 q / 2) + d3 meets the exact function at 0, at 1 and far away (eq. 6.8).
    const double d3 = -std::log(c2);
    EXPECT_NEAR(mixture.d1 + d3, exact(0.0), 1e-12);
    EXPECT_NEAR(mixture.d1 * std::exp(-0.5 * mixture.d2) + d3, exact(1.0), 1e-12);
    EXPECT_NEAR(d3, exact(1e4), 1e-12);
  }
}

TEST(NdtStatisticsTest, MomentsAddUpToThoseOfAllPoints) {
  const PointCloud cloud = yard(1, 5000);
  NdtStatistics fine(1.0, Eigen::Vector3d(-100, -100, -100)), coarse(2.0, Eigen::Vector3d(-100, -100, -100));
  for (const Eigen::Vector3d& point : cloud.points) {
    fine.add(point);
    coarse.add(point);
  }
  const NdtStatistics merged = fine.coarsened(2);
  ASSERT_EQ(merged.voxels().size(), coarse.voxels().size());
  double points = 0.0;
  for (std::size_t i = 0; i < merged.voxels().size(); ++i) {
    const auto at = std::find(coarse.keys().begin(), coarse.keys().end(), merged.keys()[i]);
    ASSERT_NE(at, coarse.keys().end());
    const VoxelMoments& expected = coarse.voxels()[at - coarse.keys().begin()];
    EXPECT_EQ(merged.voxels()[i].count, expected.count);
    EXPECT_LT((merged.voxels()[i].mean - expected.mean).norm(), 1e-9);
    EXPECT_LT((merged.voxels()[i].scatter - expected.scatter).norm(), 1e-8);
    points += expected.count;
  }
  EXPECT_EQ(points, 5000.0);
}

TEST(NdtMapTest, ASurfaceKeepsAThickness) {
  NdtStatistics statistics(1.0, Eigen::Vector3d::Zero());
  for (int i = 0; i < 100; ++i)
    statistics.add(Eigen::Vector3d(0.05 + 0.1 * (i % 10), 0.05 + 0.1 * (i / 10), 0.5));
  for (int i = 0; i < 5; ++i) statistics.add(Eigen::Vector3d(3.5, 0.1 * i, 0.5));  // too few
  const NdtMap map(statistics);
  ASSERT_EQ(map.voxels().size(), 1u);
  const double variance = 0.01 * (100.0 - 1.0) / 12.0 * 100.0 / 99.0;
  EXPECT_NEAR(map.voxels()[0].information[0], 1.0 / variance, 1e-6);
  EXPECT_NEAR(map.voxels()[0].information[5], 100.0 / variance, 1e-4);
  // It is found from itself and from the six beside it, and from no other.
  int found = 0;
  for (int x = -2; x <= 2; ++x) {
    for (int y = -2; y <= 2; ++y) {
      for (int z = -2; z <= 2; ++z)
        found += map.around(voxel_key(x, y, z)).last > map.around(voxel_key(x, y, z)).first;
    }
  }
  EXPECT_EQ(found, 7);
}

/// A score without edges between voxels, so that differences are of the same function: all points stay where
/// they are among the voxels.
TEST(NdtScoreTest, DerivativesAreThoseOfTheScore) {
  NdtStatistics statistics(4.0, Eigen::Vector3d(-1000.5, 7.25, 3.0));
  const PointCloud cloud = yard(2, 20000);
  const Eigen::Isometry3d at = pose(-3.0, 2.0, 0.5, 0.2, -0.3, 2.2);
  for (const Eigen::Vector3d& point : cloud.points) statistics.add(at * point);
  const NdtMap map(statistics);
  const NdtMixture mixture(4.0);
  const Eigen::Isometry3d near = stepped(at, (Vector6() << 0.1, -0.2, 0.05, 0.01, -0.02, 0.015).finished());
  const double h = 1e-5;
  std::vector<Eigen::Vector3d> points;
  for (std::size_t i = 0; i < cloud.size(); i += 20) {
    const Eigen::Vector3d local = (near * cloud.points[i] - map.origin()) / 4.0;
    const Eigen::Vector3d to_edge = local - local.array().round().matrix();
    if (to_edge.cwiseAbs().minCoeff() > 0.01) points.push_back(cloud.points[i]);
  }
  ASSERT_GT(points.size(), 500u);
  const NdtScore score = ndt_score(map, mixture, points, near);
  EXPECT_NEAR(score.score, ndt_score_only(map, mixture, points, near, 1), 1e-9 * score.score);
  for (int i = 0; i < 6; ++i) {
    const Vector6 step = h * Vector6::Unit(i);
    const NdtScore ahead = ndt_score(map, mixture, points, stepped(near, step));
    const NdtScore behind = ndt_score(map, mixture, points, stepped(near, -step));
    const double slope = (ahead.score - behind.score) / (2.0 * h);
    EXPECT_NEAR(score.gradient[i], slope, 1e-5 * score.gradient.norm()) << i;
    // Second differences of the score itself: the gradient's change along a step holds the turn of the axes.
    for (int k = 0; k <= i; ++k) {
      const double d = 1e-4;
      const auto value = [&](double a, double b) {
        return ndt_score(map, mixture, points,
                         stepped(near, a * d * Vector6::Unit(i) + b * d * Vector6::Unit(k)))
            .score;
      };
      const double bend = i == k
                              ? (value(1, 0) - 2.0 * value(0, 0) + value(-1, 0)) / (d * d)
                              : (value(1, 1) - value(1, -1) - value(-1, 1) + value(-1, -1)) / (4.0 * d * d);
      EXPECT_NEAR(score.hessian(i, k), bend, 1e-4 * score.hessian.norm()) << i << k;
      EXPECT_EQ(score.hessian(i, k), score.hessian(k, i));
    }
  }
}

TEST(LineSearchTest, MoreAndThuentesFunctions) {
  // Functions 1 to 3 of section 5 of the paper: from far too short to far too long.
  const std::vector<std::function<Slope(double)>> functions = {
      [](double a) {
        const double b = 2.0, d = a * a + b;
        return Slope{-a / d, (a * a - b) / (d * d)};
      },
      [](double a) {
        const double b = 0.004, c = a + b;
        return Slope{std::pow(c, 5) - 2.0 * std::pow(c, 4), 5.0 * std::pow(c, 4) - 8.0 * std::pow(c, 3)};
      },
      [](double a) {
        const double b = 0.01, l = 39.0, pi = 3.14159265358979;
        const double base = a <= 1.0 - b   ? 1.0 - a
                            : a >= 1.0 + b ? a - 1.0
                                           : (a - 1.0) * (a - 1.0) / (2.0 * b) + 0.5 * b;
        const double slope = a <= 1.0 - b ? -1.0 : a >= 1.0 + b ? 1.0 : (a - 1.0) / b;
        return Slope{base + 2.0 * (1.0 - b) / (l * pi) * std::sin(0.5 * l * pi * a),
                     slope + (1.0 - b) * std::cos(0.5 * l * pi * a)};
      }};
  for (std::size_t i = 0; i < functions.size(); ++i) {
    for (const double first : {1e-3, 1e-1, 1e1, 1e3}) {
      const Slope zero = functions[i](0.0);
      double last = 0.0;
      LineSearchParam param;
      param.decrease = param.curvature = 0.1;
      param.trials = 20;
      const auto noted = [&](double a) { return last = a, functions[i](a); };
      const LineSearchResult found = line_search(noted, zero, first, 4.0 * std::max(10.0, first), param);
      ASSERT_TRUE(found.satisfied) << i << " from " << first << " after " << found.trials;
      const Slope there = functions[i](found.length);
      EXPECT_LE(there.value, zero.value + 0.1 * found.length * zero.slope);
      EXPECT_LE(std::abs(there.slope), 0.1 * std::abs(zero.slope));
      EXPECT_EQ(last, found.length);
    }
  }
}

TEST(LineSearchTest, WithoutADescentItStays) {
  const auto rising = [](double a) { return Slope{a, 1.0}; };
  EXPECT_EQ(line_search(rising, {0.0, 1.0}, 1.0, 2.0).length, 0.0);
  // A slope that lies: nothing is lower.
  EXPECT_EQ(line_search(rising, {0.0, -1.0}, 1.0, 2.0).length, 0.0);
}

struct Found {
  NdtAlignment alignment;
  NdtVerdict verdict;
  double shift, turn;
};

Found found_from(const NdtMapPair& maps, const PointCloud& source, const Eigen::Isometry3d& truth,
                 const Eigen::Isometry3d& guess) {
  Found found;
  found.alignment = align(maps, source.points, guess, NdtMatchParam());
  NdtExpectation expected;
  expected.guess = guess;
  found.verdict = judge(maps, source.points, found.alignment, expected, NdtBeliefParam());
  const Eigen::Isometry3d error = truth.inverse() * found.alignment.target_from_source;
  found.shift = error.translation().norm();
  found.turn = Eigen::AngleAxisd(error.linear()).angle();
  return found;
}

TEST(NdtMatcherTest, FindsThePlaceFromAMetreAndThreeDegrees) {
  // The target lies where UTM coordinates are: float would be off by half a metre.
  const Eigen::Isometry3d truth = pose(587123.4, 4141240.6, 35.0, 0.02, -0.03, 2.5);
  const NdtMapPair maps = make_ndt_maps(transformed(yard(1), truth).points, 1.0);
  const PointCloud source = voxel_filter(yard(2), 0.5);
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20; ++i) {
    const Eigen::Vector3d way = Eigen::Vector3d(unit(random), unit(random), 0.3 * unit(random)).normalized();
    const Eigen::Vector3d axis = Eigen::Vector3d(unit(random), unit(random), unit(random)).normalized();
    Vector6 step;
    step << way, 0.0524 * axis;
    const Found found = found_from(maps, source, truth, stepped(truth, step));
    EXPECT_TRUE(found.alignment.converged);
    EXPECT_LT(found.shift, 0.02) << i;
    EXPECT_LT(found.turn, 0.001) << i;
    EXPECT_TRUE(found.verdict.believed) << testing::PrintToString(found.verdict.reasons);
    EXPECT_EQ(found.verdict.uncertainty.weak_directions, 0);
  }
}

TEST(NdtMatcherTest, AFalsePlaceIsNotBelieved) {
  const NdtMapPair maps = make_ndt_maps(yard(1).points, 1.0);
  const PointCloud source = voxel_filter(yard(2), 0.5);
  std::mt19937 random(4);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  int wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const Eigen::Isometry3d guess =
        pose(10.0 * unit(random), 10.0 * unit(random), 0, 0, 0, 3.14 * unit(random));
    const Found found = found_from(maps, source, Eigen::Isometry3d::Identity(), guess);
    if (found.shift < 0.3 && found.turn < 0.01) continue;
    ++wrong;
    EXPECT_FALSE(found.verdict.believed) << found.shift << " m, likelihood " << found.verdict.likelihood;
  }
  EXPECT_GT(wrong, 10);
}

TEST(NdtMatcherTest, NothingToMatchIsSaid) {
  const NdtMapPair maps = make_ndt_maps(yard(1).points, 1.0), none = make_ndt_maps(PointCloud().points, 1.0);
  const PointCloud source = voxel_filter(yard(2), 0.5);
  const Eigen::Isometry3d guess = pose(1, 2, 3, 0, 0, 1);
  Found found = found_from(maps, PointCloud(), guess, guess);
  EXPECT_THAT(found.verdict.reasons, ElementsAre("the source has no points"));
  EXPECT_EQ(found.shift, 0.0);
  found = found_from(none, source, guess, guess);
  EXPECT_THAT(found.verdict.reasons, ElementsAre("the target has no voxel with six points"));
  // A kilometre away, not one point meets the target.
  found = found_from(maps, source, guess, pose(1000, 0, 0, 0, 0, 0));
  EXPECT_FALSE(found.verdict.believed);
  EXPECT_TRUE(found.verdict.uncertainty.covariance.allFinite());
}

TEST(NdtBeliefTest, ACorridorsLengthIsSaidToBeUnknown) {
  const NdtMapPair maps = make_ndt_maps(corridor(1).points, 1.0);
  const PointCloud source = voxel_filter(crop(corridor(2), 1.0, 45.0), 0.5);
  const Found found = found_from(maps, source, Eigen::Isometry3d::Identity(), pose(0.5, 0.2, 0, 0, 0, 0.01));
  const Matrix6& covariance = found.verdict.uncertainty.covariance;
  EXPECT_EQ(found.verdict.uncertainty.weak_directions, 1);
  EXPECT_GT(std::sqrt(covariance(0, 0)), 5.0);
  EXPECT_LT(std::sqrt(covariance(1, 1)), 0.2);
  EXPECT_LT(std::abs(found.alignment.target_from_source.translation().y()), 0.03);
  EXPECT_THAT(found.verdict.remarks, ElementsAre(HasSubstr("hardly tell the place")));
  EXPECT_TRUE(found.verdict.believed) << "the wide covariance says what is not known";
}

TEST(NdtBeliefTest, WhatIsExpectedCounts) {
  const NdtMapPair maps = make_ndt_maps(yard(1).points, 1.0);
  const PointCloud source = voxel_filter(yard(2), 0.5);
  NdtExpectation expected;
  expected.guess = pose(0.8, 0, 0, 0, 0, 0);
  const NdtAlignment found = align(maps, source.points, expected.guess, NdtMatchParam());
  EXPECT_TRUE(judge(maps, source.points, found, expected, NdtBeliefParam()).believed);
  expected.guess_covariance = 0.01 * Matrix6::Identity();  // 0.1 m: then 0.8 m are not to be believed
  EXPECT_THAT(judge(maps, source.points, found, expected, NdtBeliefParam()).reasons,
              ElementsAre(HasSubstr("standard deviations from what was expected")));
  expected.guess_covariance.reset();
  expected.usual_likelihood = 0.99;
  EXPECT_THAT(judge(maps, source.points, found, expected, NdtBeliefParam()).reasons,
              ElementsAre(HasSubstr("but usually 0.99 here")));
  NdtBeliefParam near;
  near.max_correction = 0.5;
  expected.usual_likelihood.reset();
  EXPECT_THAT(judge(maps, source.points, found, expected, near).reasons,
              ElementsAre(HasSubstr("from the guess")));
}

}  // namespace
}  // namespace relative_map::core
