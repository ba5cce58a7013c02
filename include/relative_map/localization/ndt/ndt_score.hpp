#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "relative_map/localization/ndt/ndt_map.hpp"

namespace relative_map::core {

/// Translation first, then rotation.
using Vector6 = Eigen::Matrix<double, 6, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;

/// The constants of Magnusson's mixture of a normal and a uniform distribution (thesis of 2009, eq. 6.8):
/// a point's likelihood is approximated by -d1 exp(-d2 q / 2), q the squared Mahalanobis distance.
struct NdtMixture {
  static constexpr double kOutlierShare = 0.55;
  /// [m] of a voxel: below it the logarithms of d3 and d2 leave the reals, or nearly so.
  static constexpr double kLeastResolution = 0.5;

  explicit NdtMixture(double resolution);
  double d1, d2;  ///< d1 < 0
};

/// target_from_source moved by a small step, from the left: the rotation turns about the source's origin,
/// p -> Exp(w) R p + t + v. `step` is v [m], then w [rad], in the target's axes.
Eigen::Isometry3d stepped(const Eigen::Isometry3d& target_from_source, const Vector6& step);

/// What a pose is worth, and how that changes with a step as in stepped().
struct NdtScore {
  double score = 0.0;  ///< sum over points and the voxels around them; the larger the better
  Vector6 gradient = Vector6::Zero();
  Matrix6 hessian = Matrix6::Zero();  ///< in full: the points' second derivatives, too
  double nearest_sum = 0.0;           ///< sum over points of the best voxel's share in the score
  std::size_t in_voxels = 0;          ///< points with a voxel around
};

/// For points in the source's frame.
NdtScore ndt_score(const NdtMap& map, const NdtMixture& mixture, const std::vector<Eigen::Vector3d>& points,
                   const Eigen::Isometry3d& target_from_source);

/// The score alone, without derivatives, of every `stride`-th point.
double ndt_score_only(const NdtMap& map, const NdtMixture& mixture,
                      const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& target_from_source,
                      std::size_t stride);

/// What a result's covariance is made of, by steps as in stepped(). Of each voxel's inverse covariance the
/// smallest eigenvalue is taken off in all directions: that a voxel ends where it ends tells nothing of the
/// place, else a smooth wall would seem to say how far along it one is.
struct NdtInformation {
  Matrix6 information = Matrix6::Zero();  ///< Gauss and Newton's part of the negated Hessian: never negative
  /// Sum of the outer products of the gradients of groups of points, a group being the points in one voxel:
  /// their errors are not independent, since they share the voxel's.
  Matrix6 scatter = Matrix6::Zero();
  /// [m] how far a turn of 1 rad about each of the target's axes moves a typical point: by it turns are
  /// weighed against translations.
  Eigen::Vector3d levers = Eigen::Vector3d::Ones();
};
NdtInformation ndt_information(const NdtMap& map, const NdtMixture& mixture,
                               const std::vector<Eigen::Vector3d>& points,
                               const Eigen::Isometry3d& target_from_source);

}  // namespace relative_map::core
