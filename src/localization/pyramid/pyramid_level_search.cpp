#include "pyramid_level_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "relative_map/localization/clouds/cloud_filters.hpp"

namespace relative_map::core {

namespace {

/// A cell of the scan, at its place in the map if the pose is the one that is tried.
struct ScanCell {
  std::int64_t x, y;
  double intensity, intensity_variance, altitude;
};

/// One direction on one level.
struct Scan {
  std::vector<ScanCell> cells;
  double lift = 0.0;  ///< [m] that the map's ground is higher than the scan's
};

/// A cell of one or two points does not know its own variance: as if it had seen one more value, `least` off.
double variance_of(const Moments& intensity, double least) {
  return (intensity.squares + least * least) / std::max(1.0, intensity.count);
}

Scan scan_at(const PyramidMap& map, int level, const PointCloud& scan, const Eigen::Isometry3d& pose,
             double least, const PyramidParam& param) {
  const PyramidLevel& known = map.level(level);
  PyramidMap plan(known.cell_size(), map.origin());
  plan.add(transformed(scan, pose));
  const PyramidLevel& seen = plan.level(0);
  Scan result;
  std::vector<double> lifts;
  const std::size_t stride = std::max<std::size_t>(
      1, static_cast<std::size_t>(static_cast<double>(seen.cells().size()) / param.most_cells));
  for (std::size_t i = 0; i < seen.cells().size(); i += stride) {
    const PyramidCell& cell = seen.cells()[i];
    const auto at = seen.place(i);
    result.cells.push_back(
        {at.x(), at.y(), cell.intensity.mean, variance_of(cell.intensity, least), cell.altitude.mean});
    const PyramidCell* there = known.find(at.x(), at.y());
    if (there != nullptr && there->ground.count > 0.0 && cell.ground.count > 0.0) {
      lifts.push_back(there->ground.mean - cell.ground.mean);
    }
  }
  if (!lifts.empty()) {
    std::nth_element(lifts.begin(), lifts.begin() + lifts.size() / 2, lifts.end());
    result.lift = lifts[lifts.size() / 2];
  }
  return result;
}

ShiftScore score_shift(const PyramidLevel& level, const Scan& scan, int dx, int dy, double least,
                       const PyramidParam& param) {
  const double farthest = param.largest_distance * param.largest_distance;
  const double altitude_variance = param.altitude_stddev * param.altitude_stddev;
  ShiftScore score;
  for (const ScanCell& cell : scan.cells) {
    const PyramidCell* there = level.find(cell.x + dx, cell.y + dy);
    if (there == nullptr) continue;
    score.common += 1.0;
    const double intensity = there->intensity.mean - cell.intensity;
    const double variance = variance_of(there->intensity, least) + cell.intensity_variance;
    score.intensity += variance > 0.0 ? std::min(farthest, intensity * intensity / variance) : 0.0;
    const double altitude = there->altitude.mean - cell.altitude - scan.lift;
    score.altitude += std::min(farthest, altitude * altitude / altitude_variance);
  }
  if (score.common > 0.0) {
    score.intensity /= score.common;
    score.altitude /= score.common;
  }
  return score;
}

/// exp(-k/2 mean), of those shifts at which enough of the scan meets the map; sum 1.
std::vector<double> likelihoods(const std::vector<ShiftScore>& scores, double ShiftScore::*which,
                                const PyramidParam& param) {
  double most = 0.0, least = std::numeric_limits<double>::infinity();
  for (const ShiftScore& score : scores) most = std::max(most, score.common);
  for (const ShiftScore& score : scores) {
    if (score.common >= 0.5 * most && score.common > 0.0) least = std::min(least, score.*which);
  }
  std::vector<double> p;
  double sum = 0.0;
  for (const ShiftScore& score : scores) {
    const bool counts = score.common >= 0.5 * most && score.common > 0.0;
    p.push_back(counts ? std::exp(-0.5 * most / param.cells_alike * (score.*which - least)) : 0.0);
    sum += p.back();
  }
  for (double& value : p) value = sum > 0.0 ? value / sum : 1.0 / static_cast<double>(p.size());
  return p;
}

/// [cells^2] the second moments' sum.
double spread_of(const std::vector<double>& p, int reach) {
  double mx = 0.0, my = 0.0, squares = 0.0;
  std::size_t i = 0;
  for (int y = -reach; y <= reach; ++y) {
    for (int x = -reach; x <= reach; ++x, ++i) {
      mx += p[i] * x;
      my += p[i] * y;
      squares += p[i] * (x * x + y * y);
    }
  }
  return std::max(1e-3, squares - mx * mx - my * my);
}

/// P = P_i^g P_a^(1 - g): the one that is sharper gets more.
ShiftHistogram fused(const std::vector<ShiftScore>& scores, int reach, PyramidWeighing weighing,
                     const PyramidParam& param, double& intensity_weight) {
  const std::vector<double> intensity = likelihoods(scores, &ShiftScore::intensity, param);
  const std::vector<double> altitude = likelihoods(scores, &ShiftScore::altitude, param);
  const double si = spread_of(intensity, reach), sa = spread_of(altitude, reach);
  intensity_weight = weighing == PyramidWeighing::kIntensity  ? 1.0
                     : weighing == PyramidWeighing::kAltitude ? 0.0
                                                              : sa / (si + sa);
  ShiftHistogram result;
  result.reach = reach;
  double sum = 0.0;
  for (std::size_t i = 0; i < scores.size(); ++i) {
    result.p.push_back(std::pow(intensity[i], intensity_weight) *
                       std::pow(altitude[i], 1.0 - intensity_weight));
    sum += result.p.back();
  }
  for (double& p : result.p) p /= sum;
  return result;
}

}  // namespace

Eigen::Isometry3d turned(const Eigen::Isometry3d& pose, double yaw) {
  Eigen::Isometry3d result = pose;
  result.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * pose.linear();
  return result;
}

double spread_of_intensity(const PyramidLevel& level) {
  Moments all;
  for (const PyramidCell& cell : level.cells()) {
    if (cell.intensity.count > 0.0) all.add(cell.intensity.mean);
  }
  return std::sqrt(all.variance());
}

LevelResult search_level(const PyramidMap& map, int level, const PointCloud& scan,
                         const Eigen::Isometry3d& pose, int reach, const std::vector<double>& yaws,
                         PyramidWeighing weighing, double least, const PyramidParam& param,
                         PyramidMatch& match) {
  LevelResult best;
  std::vector<double> costs;
  double lowest = std::numeric_limits<double>::infinity(), common = 1.0;
  for (const double yaw : yaws) {
    const Scan turned_scan = scan_at(map, level, scan, turned(pose, yaw), least, param);
    std::vector<ShiftScore> scores;
    double most = 0.0;
    for (int dy = -reach; dy <= reach; ++dy) {
      for (int dx = -reach; dx <= reach; ++dx) {
        scores.push_back(score_shift(map.level(level), turned_scan, dx, dy, least, param));
        most = std::max(most, scores.back().common);
      }
    }
    match.candidates += static_cast<int>(scores.size());
    double weight = 0.0;
    ShiftHistogram histogram = fused(scores, reach, weighing, param, weight);
    double cost = std::numeric_limits<double>::infinity();
    for (const ShiftScore& score : scores) {
      if (score.common < 0.5 * most || score.common <= 0.0) continue;
      cost = std::min(cost, weight * score.intensity + (1.0 - weight) * score.altitude);
    }
    costs.push_back(cost);
    if (cost >= lowest) continue;
    lowest = cost;
    common = most;
    best = {histogram,
            scores,
            yaw,
            0.0,
            turned_scan.lift,
            most / std::max<double>(1.0, static_cast<double>(turned_scan.cells.size())),
            weight};
  }
  // The direction between the ones that were tried, by their likelihoods.
  double sum = 0.0, weight = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < yaws.size(); ++i) {
    const double w =
        std::isfinite(costs[i]) ? std::exp(-0.5 * common / param.cells_alike * (costs[i] - lowest)) : 0.0;
    sum += w * yaws[i];
    squares += w * yaws[i] * yaws[i];
    weight += w;
  }
  if (weight > 0.0) {
    best.yaw_stddev = std::sqrt(std::max(0.0, squares / weight - sum * sum / (weight * weight)));
    if (level == 0) best.yaw = sum / weight;
  }
  return best;
}

}  // namespace relative_map::core
