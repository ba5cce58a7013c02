// The optimality conditions of Karush, Kuhn and Tucker, which nothing but the minimum of a convex program
// fulfils.
#include "relative_map/tools/banded_program.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>

#include <cmath>
#include <random>

namespace relative_map::core {
namespace {

/// A random program of the smoother's kind: second differences, a weak pull to places, and rows that bound
/// what lies between two neighbours. `width` [m] of the bounds, which contradict each other if it is
/// negative.
BandedProgram random_program(int size, double width, double stiffness, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::normal_distribution<double> normal;
  Eigen::SparseMatrix<double> differences(size - 2, size);
  for (int i = 0; i + 2 < size; ++i) {
    differences.insert(i, i) = 1.0;
    differences.insert(i, i + 1) = -2.0;
    differences.insert(i, i + 2) = 1.0;
  }
  Eigen::SparseMatrix<double> identity(size, size);
  identity.setIdentity();
  const Eigen::SparseMatrix<double> whole = 10.0 * (differences.transpose() * differences) + 0.1 * identity;
  BandedProgram program;
  program.hessian = whole.triangularView<Eigen::Lower>();
  program.gradient = Eigen::VectorXd::NullaryExpr(size, [&] { return normal(random); });
  program.stiffness = stiffness;
  for (int i = 0; i + 1 < size; ++i) {
    const double middle = 0.5 * normal(random);
    program.rows.push_back({i, i + 1, unit(random), middle - 0.5 * width, middle + 0.5 * width});
  }
  return program;
}

/// What is left of the gradient at x, with the multipliers that the rows' violations give, by the size of its
/// terms: 0 at the minimum.
double relative_residual(const BandedProgram& program, const Eigen::VectorXd& x) {
  const Eigen::VectorXd curvature = program.hessian.selfadjointView<Eigen::Lower>() * x;
  Eigen::VectorXd rest = curvature - program.gradient;
  double scale = curvature.lpNorm<Eigen::Infinity>() + program.gradient.lpNorm<Eigen::Infinity>();
  for (const BandedProgram::Row& row : program.rows) {
    const double value = (1.0 - row.fraction) * x[row.first] + row.fraction * x[row.second];
    const double multiplier =
        program.stiffness * (std::max(0.0, value - row.upper) - std::max(0.0, row.lower - value));
    rest[row.first] += (1.0 - row.fraction) * multiplier;
    rest[row.second] += row.fraction * multiplier;
    scale = std::max(scale, std::abs(multiplier));
  }
  return rest.lpNorm<Eigen::Infinity>() / scale;
}

TEST(BandedProgram, TheSolutionMeetsTheConditionsOfOptimality) {
  for (int size : {3, 10, 200, 5000}) {
    for (double width : {2.0, 0.2, 1e-3, -0.5}) {
      for (double stiffness : {1.0, 1e3, 1e6}) {
        for (unsigned seed = 0; seed < 5; ++seed) {
          SCOPED_TRACE(testing::Message() << size << " values, bounds " << width << " wide, stiffness "
                                          << stiffness << ", seed " << seed);
          const BandedProgram program = random_program(size, width, stiffness, seed);
          int rounds = 0;
          const Eigen::VectorXd x = solve(program, [&] { ++rounds; });
          ASSERT_EQ(x.size(), size);
          EXPECT_LT(relative_residual(program, x), 1e-6);
          EXPECT_LT(rounds, 80);
        }
      }
    }
  }
}

TEST(BandedProgram, AFreeOneIsALinearEquation) {
  const BandedProgram program = random_program(50, 1e6, 1e3, 1);
  const Eigen::MatrixXd dense = Eigen::MatrixXd(program.hessian).selfadjointView<Eigen::Lower>();
  const Eigen::VectorXd expected = dense.ldlt().solve(program.gradient);
  EXPECT_LT((solve(program, [] {}) - expected).lpNorm<Eigen::Infinity>(), 1e-6);
}

TEST(BandedProgram, OneValueBetweenTwoBounds) {
  BandedProgram program = random_program(3, 1.0, 1e6, 1);
  program.rows = {{0, 1, 0.0, -1.0, 1.0}};
  program.hessian.setIdentity();
  program.hessian.coeffRef(1, 0) = 0.0;
  program.gradient = Eigen::Vector3d(5.0, 2.0, 3.0);
  const Eigen::VectorXd x = solve(program, [] {});
  EXPECT_NEAR(x[0], 1.0 + 4.0 / (1e6 + 1.0), 1e-9);  // (1 + k) x = 5 + k: the bound gives by its stiffness
  EXPECT_NEAR(x[1], 2.0, 1e-9);
  EXPECT_NEAR(x[2], 3.0, 1e-9);
}

}  // namespace
}  // namespace relative_map::core
