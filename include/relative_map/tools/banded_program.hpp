#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <functional>
#include <vector>

namespace relative_map::core {

/// A convex quadratic program over values along a line: minimise 1/2 x'Hx - g'x, where each row bounds the
/// value at a place between two neighbours.
struct BandedProgram {
  struct Row {
    int first = 0, second = 0;  ///< the neighbours
    double fraction = 0.0;      ///< [0, 1] of the way to the second
    double lower = 0.0, upper = 0.0;
  };

  Eigen::SparseMatrix<double> hessian;  ///< lower half, with entries for each row's pair; positive definite
  Eigen::VectorXd gradient;             ///< g
  std::vector<Row> rows;
  double stiffness = 1.0;  ///< what going past a bound costs: half of this times the square of how far
};

/// The solution, by a primal-dual interior-point method: some tens of sparse factorizations, however many
/// rows bind. Rows that contradict each other are met as nearly as possible. Empty if the numbers fail.
/// `iterated` is called after each round.
Eigen::VectorXd solve(const BandedProgram& program, const std::function<void()>& iterated);

}  // namespace relative_map::core
