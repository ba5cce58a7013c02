#include "relative_map/localization/ndt/ndt_covariance.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>

namespace relative_map::core {

NdtCovariance ndt_covariance(const NdtInformation& found, const NdtBeliefParam& param) {
  Vector6 scale;  // to metres
  scale << Eigen::Vector3d::Ones(), found.levers.cwiseInverse();
  NdtCovariance result;
  const Matrix6 information = scale.asDiagonal() * found.information * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(information);
  const Matrix6 axes = solver.eigenvectors();
  const double largest = solver.eigenvalues()[5];
  Matrix6 metric = Matrix6::Zero();
  if (largest > 0.0) {
    result.condition = std::max(0.0, solver.eigenvalues()[0] / largest);
    const Vector6 inverse = solver.eigenvalues().cwiseMax(1e-9 * largest).cwiseInverse();
    const Matrix6 scatter =
        axes.transpose() * (scale.asDiagonal() * found.scatter * scale.asDiagonal()) * axes;
    metric = inverse.asDiagonal() * scatter * inverse.asDiagonal();
  }
  result.weakest = axes.col(0);
  for (int i = 0; i < 6; ++i) {
    const bool weak = !(solver.eigenvalues()[i] > param.weak_share * largest);
    if (!weak) continue;
    ++result.weak_directions;
    // Nothing that was found in a weak direction is worth keeping, correlations included.
    metric.row(i).setZero();
    metric.col(i).setZero();
    metric(i, i) = param.weak_stddev * param.weak_stddev;
  }
  const Matrix6 target = axes * metric * axes.transpose();
  result.covariance = scale.asDiagonal() * target * scale.asDiagonal();
  for (int i = 0; i < 6; ++i) {
    const double least = i < 3 ? param.min_translation_stddev : param.min_rotation_stddev;
    result.covariance(i, i) += least * least;
  }
  result.covariance = 0.5 * (result.covariance + result.covariance.transpose()).eval();
  return result;
}

}  // namespace relative_map::core
