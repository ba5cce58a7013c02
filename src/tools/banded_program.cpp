#include "relative_map/tools/banded_program.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

using Eigen::ArrayXd;
using Eigen::VectorXd;

constexpr int kMaxRounds = 80;
constexpr double kStartOfBarrier = 1e-3;
constexpr double kEndOfBarrier = 1e-13;
constexpr double kNearlyAll = 0.995;  // of the way to the border

/// A bound's slack and multiplier, for all rows: residual, and the step that Newton takes.
struct Side {
  double stiffness = 1.0;
  ArrayXd slack, multiplier, residual, complement, weight, slack_step, multiplier_step;

  void start(const ArrayXd& distance, double stiffness_of_bound) {
    stiffness = stiffness_of_bound;
    slack = distance.max(1e-2);
    multiplier = kStartOfBarrier / slack;
  }
  /// `distance` from the value to the bound, positive inside.
  void update(const ArrayXd& distance) {
    residual = slack - multiplier / stiffness - distance;
    weight = 1.0 / (slack / multiplier + 1.0 / stiffness);
  }
  ArrayXd force() const { return weight * (residual - complement / multiplier); }
  /// `change` of the distance that the step of x brings.
  void step(const ArrayXd& change) {
    multiplier_step = weight * (-change + residual - complement / multiplier);
    slack_step = -(complement + slack * multiplier_step) / multiplier;
  }
  double longest_step() const {
    double length = 1.0;
    for (Eigen::Index i = 0; i < slack.size(); ++i) {
      if (slack_step[i] < 0.0) length = std::min(length, -kNearlyAll * slack[i] / slack_step[i]);
      if (multiplier_step[i] < 0.0)
        length = std::min(length, -kNearlyAll * multiplier[i] / multiplier_step[i]);
    }
    return length;
  }
  double product() const { return (slack * multiplier).sum(); }
  double product_after(double length) const {
    return ((slack + length * slack_step) * (multiplier + length * multiplier_step)).sum();
  }
  void advance(double length) {
    slack += length * slack_step;
    multiplier += length * multiplier_step;
  }
};

class Solver {
 public:
  explicit Solver(const BandedProgram& program) : program_(program), matrix_(program.hessian) {
    matrix_.makeCompressed();
    for (const BandedProgram::Row& row : program.rows) {
      places_.push_back(
          {place(row.first, row.first), place(row.second, row.second), place(row.first, row.second)});
    }
    hessian_values_.assign(matrix_.valuePtr(), matrix_.valuePtr() + matrix_.nonZeros());
    factors_.analyzePattern(matrix_);
    const auto rows = static_cast<Eigen::Index>(program.rows.size());
    lower_bound_.resize(rows);
    upper_bound_.resize(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      lower_bound_[i] = program.rows[i].lower;
      upper_bound_[i] = program.rows[i].upper;
    }
    x_ = VectorXd::Zero(program.gradient.size());
    upper_.start(upper_bound_, program.stiffness);
    lower_.start(-lower_bound_, program.stiffness);
  }

  VectorXd solve(const std::function<void()>& iterated) {
    for (int round = 0; round < kMaxRounds; ++round) {
      if (!iterate()) return {};
      iterated();
      if (barrier_ < kEndOfBarrier && last_step_ < 1e-9) break;
    }
    return x_;
  }

 private:
  struct Places {
    Eigen::Index first, second, between;
  };

  Eigen::Index place(int a, int b) {
    return &matrix_.coeffRef(std::max(a, b), std::min(a, b)) - matrix_.valuePtr();
  }

  ArrayXd values(const VectorXd& x) const {
    ArrayXd result(static_cast<Eigen::Index>(program_.rows.size()));
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      const BandedProgram::Row& row = program_.rows[i];
      result[i] = (1.0 - row.fraction) * x[row.first] + row.fraction * x[row.second];
    }
    return result;
  }

  VectorXd spread(const ArrayXd& forces) const {
    VectorXd result = VectorXd::Zero(x_.size());
    for (Eigen::Index i = 0; i < forces.size(); ++i) {
      const BandedProgram::Row& row = program_.rows[i];
      result[row.first] += (1.0 - row.fraction) * forces[i];
      result[row.second] += row.fraction * forces[i];
    }
    return result;
  }

  bool factorize() {
    double* values = matrix_.valuePtr();
    std::copy(hessian_values_.begin(), hessian_values_.end(), values);
    for (std::size_t i = 0; i < places_.size(); ++i) {
      const auto row = static_cast<Eigen::Index>(i);
      const double weight = upper_.weight[row] + lower_.weight[row];
      const double b = program_.rows[i].fraction, a = 1.0 - b;
      values[places_[i].first] += weight * a * a;
      values[places_[i].second] += weight * b * b;
      values[places_[i].between] += weight * a * b;
    }
    factors_.factorize(matrix_);
    return factors_.info() == Eigen::Success;
  }

  VectorXd newton_step(const VectorXd& residual) {
    const VectorXd step = factors_.solve(-residual - spread(upper_.force() - lower_.force()));
    const ArrayXd change = values(step);
    upper_.step(-change);
    lower_.step(change);
    return step;
  }

  double longest_step() const { return std::min(upper_.longest_step(), lower_.longest_step()); }

  /// One step of Mehrotra's method: how far a step without barrier gets tells how much of it is still needed.
  bool iterate() {
    const ArrayXd now = values(x_);
    upper_.update(upper_bound_ - now);
    lower_.update(now - lower_bound_);
    const VectorXd residual = program_.hessian.selfadjointView<Eigen::Lower>() * x_ - program_.gradient +
                              spread(upper_.multiplier - lower_.multiplier);
    if (!factorize()) return false;

    const double count = std::max<double>(1.0, 2.0 * static_cast<double>(places_.size()));
    barrier_ = (upper_.product() + lower_.product()) / count;
    for (Side* side : {&upper_, &lower_}) side->complement = side->slack * side->multiplier;
    newton_step(residual);
    double length = longest_step();
    const double reached = (upper_.product_after(length) + lower_.product_after(length)) / count;
    const double share = std::pow(reached / std::max(barrier_, 1e-300), 3);
    for (Side* side : {&upper_, &lower_}) {
      side->complement =
          side->slack * side->multiplier + side->slack_step * side->multiplier_step - share * barrier_;
    }
    const VectorXd step = newton_step(residual);
    length = longest_step();
    x_ += length * step;
    upper_.advance(length);
    lower_.advance(length);
    last_step_ = length * step.lpNorm<Eigen::Infinity>();
    return x_.allFinite();
  }

  const BandedProgram& program_;
  Eigen::SparseMatrix<double> matrix_;
  std::vector<double> hessian_values_;
  std::vector<Places> places_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>, Eigen::Lower> factors_;
  ArrayXd lower_bound_, upper_bound_;
  VectorXd x_;
  Side upper_, lower_;
  double barrier_ = 1.0, last_step_ = 0.0;
};

}  // namespace

Eigen::VectorXd solve(const BandedProgram& program, const std::function<void()>& iterated) {
  return Solver(program).solve(iterated);
}

}  // namespace relative_map::core
