#include "relative_map/localization/ndt/ndt_score.hpp"

#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

// Beyond it a voxel's share is below 1e-7 of that at its mean, and exp() is not worth its time.
constexpr double kLargestExponent = 16.0;

/// The score of one point, and its derivatives by the point's place in the target.
struct PointScore {
  double score = 0.0, nearest = 0.0;
  double gx = 0.0, gy = 0.0, gz = 0.0;                                      // [1/m]
  double hxx = 0.0, hxy = 0.0, hxz = 0.0, hyy = 0.0, hyz = 0.0, hzz = 0.0;  // [1/m^2]
};

template <bool derivatives>
PointScore score_point(const NdtMap& map, const NdtMixture& mixture, NdtMap::Range around,
                       const Eigen::Vector3d& local) {
  PointScore sum;
  const std::uint32_t* neighbours = map.neighbours().data();
  const NdtVoxel* voxels = map.voxels().data();
  for (std::uint32_t n = around.first; n < around.last; ++n) {
    const NdtVoxel& voxel = voxels[neighbours[n]];
    const double dx = local.x() - voxel.mean[0];
    const double dy = local.y() - voxel.mean[1];
    const double dz = local.z() - voxel.mean[2];
    const auto& b = voxel.information;
    const double bx = b[0] * dx + b[1] * dy + b[2] * dz;
    const double by = b[1] * dx + b[3] * dy + b[4] * dz;
    const double bz = b[2] * dx + b[4] * dy + b[5] * dz;
    const double exponent = 0.5 * mixture.d2 * (dx * bx + dy * by + dz * bz);
    if (!(exponent < kLargestExponent)) continue;
    const double e = -mixture.d1 * std::exp(-exponent);
    sum.score += e;
    sum.nearest = std::max(sum.nearest, e);
    if (!derivatives) continue;
    const double w = mixture.d2 * e;
    sum.gx -= w * bx;
    sum.gy -= w * by;
    sum.gz -= w * bz;
    const double d2 = mixture.d2;
    sum.hxx += w * (d2 * bx * bx - b[0]);
    sum.hxy += w * (d2 * bx * by - b[1]);
    sum.hxz += w * (d2 * bx * bz - b[2]);
    sum.hyy += w * (d2 * by * by - b[3]);
    sum.hyz += w * (d2 * by * bz - b[4]);
    sum.hzz += w * (d2 * bz * bz - b[5]);
  }
  return sum;
}

/// Adds a point's derivatives, carried on to the step's six numbers. With r = R p the place moves by
/// v + w x r + w x (w x r) / 2: the first part gives J = [I, -[r]x], the second the last lines here.
void add_by_step(const PointScore& p, const Eigen::Vector3d& r, NdtScore& sum) {
  Eigen::Matrix3d h;
  h << p.hxx, p.hxy, p.hxz, p.hxy, p.hyy, p.hyz, p.hxz, p.hyz, p.hzz;
  const double x = r.x(), y = r.y(), z = r.z();
  // Columns of -[r]x: what a unit rotation about each axis does to the place.
  Eigen::Matrix3d turn;
  turn << 0.0, z, -y, -z, 0.0, x, y, -x, 0.0;
  const Eigen::Vector3d g(p.gx, p.gy, p.gz);
  sum.gradient.head<3>() += g;
  sum.gradient.tail<3>() += r.cross(g);
  const Eigen::Matrix3d mixed = h * turn;
  sum.hessian.topLeftCorner<3, 3>() += h;
  sum.hessian.topRightCorner<3, 3>() += mixed;
  Eigen::Matrix3d turning;
  turning.noalias() = turn.transpose() * mixed;
  const double along = g.dot(r);
  turning(0, 0) += p.gx * x - along;
  turning(1, 1) += p.gy * y - along;
  turning(2, 2) += p.gz * z - along;
  const double xy = 0.5 * (p.gx * y + p.gy * x);
  const double xz = 0.5 * (p.gx * z + p.gz * x);
  const double yz = 0.5 * (p.gy * z + p.gz * y);
  turning(0, 1) += xy;
  turning(0, 2) += xz;
  turning(1, 0) += xy;
  turning(1, 2) += yz;
  turning(2, 0) += xz;
  turning(2, 1) += yz;
  sum.hessian.bottomRightCorner<3, 3>() += turning;
}

Eigen::Matrix3d skew(const Eigen::Vector3d& v) {
  Eigen::Matrix3d matrix;
  matrix << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
  return matrix;
}

}  // namespace

NdtMixture::NdtMixture(double resolution) {
  const double c1 = 10.0 * (1.0 - kOutlierShare);
  const double c2 = kOutlierShare / (resolution * resolution * resolution);
  const double d3 = -std::log(c2);
  d1 = -std::log(c1 + c2) - d3;
  d2 = -2.0 * std::log((-std::log(c1 * std::exp(-0.5) + c2) - d3) / d1);
}

Eigen::Isometry3d stepped(const Eigen::Isometry3d& target_from_source, const Vector6& step) {
  Eigen::Isometry3d result = target_from_source;
  result.translation() += step.head<3>();
  const double angle = step.tail<3>().norm();
  if (angle > 0.0) {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(angle, step.tail<3>() / angle));
    // By quaternions, and made of unit length: many steps must not bend the axes.
    result.linear() = (turn * Eigen::Quaterniond(result.linear())).normalized().toRotationMatrix();
  }
  return result;
}

NdtScore ndt_score(const NdtMap& map, const NdtMixture& mixture, const std::vector<Eigen::Vector3d>& points,
                   const Eigen::Isometry3d& target_from_source) {
  NdtScore sum;
  const Eigen::Matrix3d rotation = target_from_source.linear();
  const Eigen::Vector3d shift = target_from_source.translation() - map.origin();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d r = rotation * point;
    const Eigen::Vector3d local = r + shift;
    const NdtMap::Range around = map.around(map.key_of(local));
    if (around.first == around.last) continue;
    ++sum.in_voxels;
    const PointScore p = score_point<true>(map, mixture, around, local);
    if (p.score == 0.0) continue;
    sum.score += p.score;
    sum.nearest_sum += p.nearest;
    add_by_step(p, r, sum);
  }
  sum.hessian.bottomLeftCorner<3, 3>() = sum.hessian.topRightCorner<3, 3>().transpose();
  const Eigen::Matrix3d turning = sum.hessian.bottomRightCorner<3, 3>();
  sum.hessian.bottomRightCorner<3, 3>() = 0.5 * (turning + turning.transpose());  // but for rounding, it is
  return sum;
}

double ndt_score_only(const NdtMap& map, const NdtMixture& mixture,
                      const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& target_from_source,
                      std::size_t stride) {
  double score = 0.0;
  const Eigen::Matrix3d rotation = target_from_source.linear();
  const Eigen::Vector3d shift = target_from_source.translation() - map.origin();
  for (std::size_t i = 0; i < points.size(); i += stride) {
    const Eigen::Vector3d local = rotation * points[i] + shift;
    score += score_point<false>(map, mixture, map.around(map.key_of(local)), local).score;
  }
  return score;
}

NdtInformation ndt_information(const NdtMap& map, const NdtMixture& mixture,
                               const std::vector<Eigen::Vector3d>& points,
                               const Eigen::Isometry3d& target_from_source) {
  NdtInformation result;
  VoxelIndex groups;
  std::vector<Vector6> gradients;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  const Eigen::Matrix3d rotation = target_from_source.linear();
  const Eigen::Vector3d shift = target_from_source.translation() - map.origin();
  for (const Eigen::Vector3d& point : points) {
    const Eigen::Vector3d r = rotation * point;
    const Eigen::Vector3d local = r + shift;
    const VoxelKey key = map.key_of(local);
    const NdtMap::Range around = map.around(key);
    if (around.first == around.last) continue;
    const auto next = static_cast<std::int32_t>(gradients.size());
    const std::int32_t at = groups.insert(key, next);
    if (at == next) gradients.push_back(Vector6::Zero());
    Eigen::Matrix<double, 3, 6> jacobian;
    jacobian << Eigen::Matrix3d::Identity(), -skew(r);
    squares += Eigen::Vector3d::Constant(r.squaredNorm()) - r.cwiseAbs2();
    for (std::uint32_t n = around.first; n < around.last; ++n) {
      const NdtVoxel& voxel = map.voxels()[map.neighbours()[n]];
      const auto& b = voxel.information;
      Eigen::Matrix3d inverse;
      inverse << b[0], b[1], b[2], b[1], b[3], b[4], b[2], b[4], b[5];
      const Eigen::Vector3d apart = local - Eigen::Map<const Eigen::Vector3d>(voxel.mean.data());
      const double exponent = 0.5 * mixture.d2 * apart.dot(inverse * apart);
      if (!(exponent < kLargestExponent)) continue;
      const double weight = -mixture.d1 * mixture.d2 * std::exp(-exponent);
      inverse -= voxel.least_information * Eigen::Matrix3d::Identity();
      gradients[at] -= weight * jacobian.transpose() * (inverse * apart);
      result.information += weight * jacobian.transpose() * inverse * jacobian;
    }
  }
  if (!points.empty()) {
    result.levers = (squares / static_cast<double>(points.size())).cwiseSqrt().cwiseMax(0.1);
  }
  for (const Vector6& gradient : gradients) result.scatter += gradient * gradient.transpose();
  return result;
}

}  // namespace relative_map::core
