#include "relative_map/localization/ndt/ndt_start.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace relative_map::core {

namespace {

constexpr double kSpacing = 1.5;      // [m] of the lattice's positions
constexpr double kTurn = 0.1745;      // [rad] (10 deg) of its directions
constexpr std::size_t kLooked = 600;  // [-] points that each knot is looked at with
constexpr std::size_t kAligned = 16;  // [-] knots that are aligned
constexpr double kSamePlace = 0.5;    // [m]
constexpr double kSameTurn = 0.087;   // [rad] (5 deg)
constexpr double kClearly = 0.85;     // [-] the likelihood of another place, over the best one's

struct Knot {
  Eigen::Isometry3d pose;
  double score;
};

/// Where a knot has led to, and how well what tells places apart lies there, [0, 1].
struct End {
  NdtAlignment alignment;
  double likelihood;
};

std::vector<Knot> lattice(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                          const NdtStartRequest& request) {
  const NdtMixture mixture(maps.coarse->resolution());
  const std::size_t stride = std::max<std::size_t>(1, points.size() / kLooked);
  const int steps = static_cast<int>(std::ceil(request.radius / kSpacing));
  const int turns = std::max(1, static_cast<int>(std::ceil(2.0 * request.yaw_range / kTurn)));
  std::vector<Knot> knots;
  for (int ix = -steps; ix <= steps; ++ix) {
    for (int iy = -steps; iy <= steps; ++iy) {
      const Eigen::Vector3d shift(kSpacing * ix, kSpacing * iy, 0.0);
      if (shift.norm() > std::max(request.radius, 1e-3)) continue;
      for (int turn = 0; turn < turns; ++turn) {
        const double yaw = turns == 1 ? 0.0 : -request.yaw_range + 2.0 * request.yaw_range * turn / turns;
        Knot knot{request.around, 0.0};
        knot.pose.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * request.around.linear();
        knot.pose.translation() += shift;
        knot.score = ndt_score_only(*maps.coarse, mixture, points, knot.pose, stride);
        knots.push_back(knot);
      }
    }
  }
  return knots;
}

bool same_place(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  const Eigen::Isometry3d apart = a.inverse() * b;
  return apart.translation().norm() < kSamePlace && Eigen::AngleAxisd(apart.linear()).angle() < kSameTurn;
}

}  // namespace

NdtStart find_start(const NdtMapPair& maps, const std::vector<Eigen::Vector3d>& points,
                    const NdtStartRequest& request, const NdtMatchParam& match, NdtBeliefParam belief) {
  NdtStart start;
  start.best.target_from_source = request.around;
  if (points.empty() || maps.coarse == nullptr || maps.coarse->empty()) {
    start.why_not = points.empty() ? "the cloud has no points" : "the map has nothing here";
    return start;
  }
  // The ground is alike everywhere: what stands on it tells the places apart, where there is enough of it.
  std::vector<Eigen::Vector3d> telling = upright_points(points);
  if (static_cast<double>(telling.size()) < belief.min_points) telling = points;
  std::vector<Knot> knots = lattice(maps, telling, request);
  start.candidates = static_cast<int>(knots.size());
  const std::size_t aligned = std::min(kAligned, knots.size());
  std::partial_sort(knots.begin(), knots.begin() + aligned, knots.end(),
                    [](const Knot& a, const Knot& b) { return a.score > b.score; });
  const NdtMixture mixture(maps.fine->resolution());
  const double highest = -mixture.d1 * static_cast<double>(telling.size());
  std::vector<End> ends;
  for (std::size_t i = 0; i < aligned; ++i) {
    End end{align(maps, points, knots[i].pose, match), 0.0};
    end.likelihood =
        ndt_score(*maps.fine, mixture, telling, end.alignment.target_from_source).nearest_sum / highest;
    ends.push_back(end);
  }
  std::stable_sort(ends.begin(), ends.end(),
                   [](const End& a, const End& b) { return a.likelihood > b.likelihood; });
  start.best = ends.front().alignment;
  for (const End& end : ends) {
    if (same_place(end.alignment.target_from_source, start.best.target_from_source)) continue;
    start.runner_up = end.likelihood / std::max(1e-12, ends.front().likelihood);
    break;
  }
  // The search has gone far from where it began on purpose.
  belief.max_correction = request.radius + kSpacing + belief.max_correction;
  belief.max_turn = 10.0;
  NdtExpectation expected;
  expected.guess = request.around;
  start.verdict = judge(maps, points, start.best, expected, belief);
  if (!start.verdict.believed) {
    start.why_not = start.verdict.reasons.front();
  } else if (start.runner_up > kClearly) {
    std::ostringstream text;
    text.precision(2);
    text << "two places are alike: the second best has " << start.runner_up
         << " of the best one's likelihood " << ends.front().likelihood;
    start.why_not = text.str();
  }
  start.reliable = start.why_not.empty();
  return start;
}

}  // namespace relative_map::core
