#include "relative_map/localization/ndt/ndt_belief.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

/// The step from the guess to the result, as in stepped().
Vector6 correction_of(const Eigen::Isometry3d& guess, const Eigen::Isometry3d& result) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(result.linear() * guess.linear().transpose()));
  Vector6 correction;
  correction << result.translation() - guess.translation(), turn.angle() * turn.axis();
  return correction;
}

void check_correction(const Vector6& correction, const NdtExpectation& expected, const NdtBeliefParam& param,
                      NdtVerdict& verdict) {
  const double shift = correction.head<3>().norm(), turn = correction.tail<3>().norm();
  if (!(shift <= param.max_correction)) {
    verdict.reasons.push_back(
        sentence("the result is ", shift, " m from the guess, more than ", param.max_correction, " m"));
  }
  if (!(turn <= param.max_turn)) {
    verdict.reasons.push_back(sentence("the result is turned by ", turn, " rad from the guess, more than ",
                                       param.max_turn, " rad"));
  }
  if (!expected.guess_covariance) return;
  const Matrix6 innovation = *expected.guess_covariance + verdict.uncertainty.covariance;
  const double distance = correction.dot(innovation.ldlt().solve(correction));
  if (!(distance <= param.max_innovation)) {
    verdict.reasons.push_back(sentence("the result is ", std::sqrt(std::abs(distance)),
                                       " standard deviations from what was expected"));
  }
}

/// Larger voxels are easier to meet, also by mistake; so found on pairs of scans, see the documentation.
double least_likelihood(double resolution, const NdtBeliefParam& param) {
  return param.min_likelihood * std::min(resolution, 1.0) *
         (1.0 + 0.25 * std::clamp(resolution - 1.0, 0.0, 2.0));
}

/// Whether the points lie on the target's surfaces: all, and those that are not on the ground.
void check_likelihood(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                      const NdtAlignment& alignment, const NdtBeliefParam& param, NdtVerdict& verdict) {
  const NdtMixture mixture(maps.fine->resolution());
  const double least = least_likelihood(maps.fine->resolution(), param);
  if (!(verdict.likelihood >= least)) {
    verdict.reasons.push_back(sentence("the points lie badly on the target's surfaces: likelihood ",
                                       verdict.likelihood, ", at least ", least, " is needed"));
  }
  const std::vector<Eigen::Vector3d> upright = upright_points(points);
  if (static_cast<double>(upright.size()) < param.min_points) return;  // their weak directions tell that
  const NdtScore score = ndt_score(*maps.fine, mixture, upright, alignment.target_from_source);
  verdict.upright_likelihood = score.nearest_sum / (-mixture.d1 * static_cast<double>(upright.size()));
  const double least_upright = param.upright_share * least;
  if (verdict.upright_likelihood >= least_upright) return;
  verdict.reasons.push_back(sentence("what stands on the ground is not where the target has it: likelihood ",
                                     verdict.upright_likelihood, ", at least ", least_upright, " is needed"));
}

}  // namespace

std::vector<Eigen::Vector3d> upright_points(const std::vector<Eigen::Vector3d>& points) {
  constexpr double kColumn = 1.0;  // [m] wide
  constexpr double kAbove = 0.4;   // [m] more than any ground rises within a column, but on cliffs
  VoxelIndex columns;
  std::vector<double> lowest;
  std::vector<std::int32_t> column_of;
  for (const Eigen::Vector3d& point : points) {
    const auto next = static_cast<std::int32_t>(lowest.size());
    const VoxelKey key = voxel_key(Eigen::Vector3d(point.x(), point.y(), 0.0), 1.0 / kColumn);
    column_of.push_back(columns.insert(key, next));
    if (column_of.back() == next) lowest.push_back(point.z());
    lowest[column_of.back()] = std::min(lowest[column_of.back()], point.z());
  }
  std::vector<Eigen::Vector3d> upright;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (points[i].z() > lowest[column_of[i]] + kAbove) upright.push_back(points[i]);
  }
  return upright;
}

NdtVerdict judge(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                 const NdtAlignment& alignment, const NdtExpectation& expected, const NdtBeliefParam& param) {
  NdtVerdict verdict;
  verdict.uncertainty.covariance = Matrix6::Identity() * param.weak_stddev * param.weak_stddev;
  if (points.empty()) verdict.reasons.push_back("the source has no points");
  if (maps.fine == nullptr || maps.fine->empty()) {
    verdict.reasons.push_back("the target has no voxel with six points");
  }
  if (!verdict.reasons.empty()) return verdict;
  const NdtMixture mixture(maps.fine->resolution());
  const double count = static_cast<double>(points.size());
  verdict.likelihood = alignment.at_end.nearest_sum / (-mixture.d1 * count);
  verdict.overlap = static_cast<double>(alignment.at_end.in_voxels) / count;
  verdict.uncertainty =
      ndt_covariance(ndt_information(*maps.fine, mixture, points, alignment.target_from_source), param);
  if (!alignment.converged) {
    verdict.reasons.push_back(sentence("the search did not settle: ", alignment.iterations,
                                       " steps, of which ", alignment.oscillations, " turned back"));
  }
  if (static_cast<double>(alignment.at_end.in_voxels) < param.min_points) {
    verdict.reasons.push_back(sentence("only ", alignment.at_end.in_voxels, " points meet the target"));
  }
  if (!(verdict.overlap >= param.min_overlap)) {
    verdict.reasons.push_back(
        sentence("only ", 100.0 * verdict.overlap, " % of the source meet the target's voxels"));
  }
  check_likelihood(maps, points, alignment, param, verdict);
  if (expected.usual_likelihood &&
      !(verdict.likelihood >= param.min_place_share * *expected.usual_likelihood)) {
    verdict.reasons.push_back(sentence("the likelihood is ", verdict.likelihood, ", but usually ",
                                       *expected.usual_likelihood, " here"));
  }
  check_correction(correction_of(expected.guess, alignment.target_from_source), expected, param, verdict);
  if (verdict.uncertainty.weak_directions == 6) {
    verdict.reasons.push_back("the surroundings tell nothing of the place");
  } else if (verdict.uncertainty.weak_directions > 0) {
    verdict.remarks.push_back(
        sentence("in ", verdict.uncertainty.weak_directions,
                 " of 6 directions the surroundings hardly tell the place: the covariance "
                 "says so"));
  }
  verdict.believed = verdict.reasons.empty();
  return verdict;
}

}  // namespace relative_map::core
