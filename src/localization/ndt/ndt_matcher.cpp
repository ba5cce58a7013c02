#include "relative_map/localization/ndt/ndt_matcher.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "relative_map/localization/ndt/line_search.hpp"

namespace relative_map::core {

namespace {

constexpr double kFlatShare = 1e-6;  // [-] of the largest curvature: flatter is taken to be this curved

/// What one grid is to do.
struct Stage {
  const NdtMap& map;
  const std::vector<Eigen::Vector3d>& points;
  double lever;  ///< [m]
  int iterations;
  double translation_end, rotation_end;  ///< [m], [rad]
};

Vector6 scale_of(double lever) {
  Vector6 scale;
  scale << 1.0, 1.0, 1.0, 1.0 / lever, 1.0 / lever, 1.0 / lever;
  return scale;
}

/// The step that Newton's method would take on a score with the same slopes whose curvature is downward in
/// all directions. In metres throughout: rotations by what they move.
Vector6 uphill(const NdtScore& at, const Vector6& scale) {
  const Matrix6 curvature = -(scale.asDiagonal() * at.hessian * scale.asDiagonal());
  const Vector6 slope = scale.asDiagonal() * at.gradient;
  const Eigen::SelfAdjointEigenSolver<Matrix6> solver(curvature);
  const double largest = solver.eigenvalues().cwiseAbs().maxCoeff();
  if (!(largest > 0.0)) return Vector6::Zero();
  const Vector6 bent = solver.eigenvalues().cwiseAbs().cwiseMax(kFlatShare * largest);
  const Vector6 along = solver.eigenvectors().transpose() * slope;
  return solver.eigenvectors() * (along.array() / bent.array()).matrix();
}

void climb(const Stage& stage, const NdtMatchParam& param, NdtAlignment& result) {
  const NdtMixture mixture(stage.map.resolution());
  const Vector6 scale = scale_of(stage.lever);
  NdtScore now = ndt_score(stage.map, mixture, stage.points, result.target_from_source);
  ++result.evaluations;
  Vector6 last = Vector6::Zero();
  double longest = param.far_step;
  result.converged = false;
  for (int i = 0; i < stage.iterations && now.in_voxels > 0; ++i) {
    const Vector6 direction = uphill(now, scale);
    const double length = direction.norm();
    if (!(length > 0.0) || !std::isfinite(length)) break;
    const Vector6 unit = scale.asDiagonal() * (direction / length);
    if (direction.dot(last) < -0.5 * length * last.norm()) {
      ++result.oscillations;
      longest = param.near_step;
    }
    const Eigen::Isometry3d from = result.target_from_source;
    NdtScore tried;
    const auto descent = [&](double along) {
      tried = ndt_score(stage.map, mixture, stage.points, stepped(from, along * unit));
      ++result.evaluations;
      return Slope{-tried.score, -tried.gradient.dot(unit)};
    };
    const LineSearchResult found =
        line_search(descent, {-now.score, -now.gradient.dot(unit)}, length, longest);
    ++result.iterations;
    if (found.length <= 0.0) {
      // No length raises the score: as high as rounding lets it, if the step was a short one.
      result.converged = length < 10.0 * stage.translation_end;
      break;
    }
    const Vector6 step = found.length * unit;
    result.target_from_source = stepped(from, step);
    now = tried;
    last = direction;
    if (step.head<3>().norm() < stage.translation_end && step.tail<3>().norm() < stage.rotation_end) {
      result.converged = true;
      break;
    }
    if (result.oscillations > param.oscillations) break;
  }
  result.at_end = now;
}

std::vector<Eigen::Vector3d> thinned(const std::vector<Eigen::Vector3d>& points, double most) {
  const auto stride = static_cast<std::size_t>(std::ceil(static_cast<double>(points.size()) / most));
  std::vector<Eigen::Vector3d> kept;
  kept.reserve(points.size() / stride + 1);
  for (std::size_t i = 0; i < points.size(); i += stride) kept.push_back(points[i]);
  return kept;
}

}  // namespace

NdtMapPair make_ndt_maps(const NdtStatistics& statistics) {
  return {std::make_shared<NdtMap>(statistics), std::make_shared<NdtMap>(statistics.coarsened(2))};
}

NdtMapPair make_ndt_maps(const std::vector<Eigen::Vector3d>& points, double resolution) {
  NdtStatistics statistics(resolution, points.empty() ? Eigen::Vector3d::Zero().eval() : points.front());
  for (const Eigen::Vector3d& point : points) statistics.add(point);
  return make_ndt_maps(statistics);
}

double lever_of(const std::vector<Eigen::Vector3d>& points) {
  double sum = 0.0;
  for (const Eigen::Vector3d& point : points) sum += point.head<2>().squaredNorm();
  return points.empty() ? 1.0 : std::max(1.0, std::sqrt(sum / static_cast<double>(points.size())));
}

NdtAlignment align(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                   const Eigen::Isometry3d& guess, const NdtMatchParam& param) {
  NdtAlignment result;
  result.target_from_source = guess;
  if (points.empty() || maps.fine == nullptr || maps.fine->empty()) return result;
  const double lever = lever_of(points);
  if (param.coarse_start && maps.coarse != nullptr && !maps.coarse->empty()) {
    const std::vector<Eigen::Vector3d> few = thinned(points, param.coarse_points);
    // Only so far that the fine voxels can take over.
    climb({*maps.coarse, few, lever, param.iterations / 2, 5.0 * param.translation_end,
           5.0 * param.rotation_end},
          param, result);
    result.oscillations = 0;
  }
  climb({*maps.fine, points, lever, param.iterations, param.translation_end, param.rotation_end}, param,
        result);
  return result;
}

}  // namespace relative_map::core
