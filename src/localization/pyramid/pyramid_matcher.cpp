#include "relative_map/localization/pyramid/pyramid_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "relative_map/localization/clouds/cloud_filters.hpp"

namespace relative_map::core {

namespace {

constexpr int kPeakReach = 3;          // [-] cells around a peak that belong to it
constexpr double kTiltStddev = 0.01;   // [rad] of roll and pitch, which are the guess's
constexpr double kHeightStddev = 0.1;  // [m] of z, which is the ground's

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

/// What a shift is worth: mean squared distances of the cells that scan and map have in common.
struct ShiftScore {
  double common = 0.0, intensity = 0.0, altitude = 0.0;
};

double spread_of_intensity(const PyramidLevel& level) {
  Moments all;
  for (const PyramidCell& cell : level.cells()) {
    if (cell.intensity.count > 0.0) all.add(cell.intensity.mean);
  }
  return std::sqrt(all.variance());
}

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

struct Peak {
  int x = 0, y = 0;
  double height = 0.0;
};

Peak highest(const ShiftHistogram& h) {
  Peak peak;
  for (int y = -h.reach; y <= h.reach; ++y) {
    for (int x = -h.reach; x <= h.reach; ++x) {
      if (h.at(x, y) > peak.height) peak = {x, y, h.at(x, y)};
    }
  }
  return peak;
}

/// The highest of the other local maxima, over the peak's height.
double second_peak(const ShiftHistogram& h, const Peak& peak) {
  double second = 0.0;
  for (int y = -h.reach; y <= h.reach; ++y) {
    for (int x = -h.reach; x <= h.reach; ++x) {
      if (std::max(std::abs(x - peak.x), std::abs(y - peak.y)) <= kPeakReach) continue;
      bool top = true;
      for (int ny = std::max(y - 1, -h.reach); ny <= std::min(y + 1, h.reach); ++ny) {
        for (int nx = std::max(x - 1, -h.reach); nx <= std::min(x + 1, h.reach); ++nx) {
          top = top && h.at(nx, ny) <= h.at(x, y);
        }
      }
      if (top) second = std::max(second, h.at(x, y));
    }
  }
  return second / peak.height;
}

/// [cells] the centre of mass of P^alpha around the peak.
Eigen::Vector2d centre_of(const ShiftHistogram& h, const Peak& peak, double alpha) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  double weight = 0.0;
  for (int y = std::max(peak.y - kPeakReach, -h.reach); y <= std::min(peak.y + kPeakReach, h.reach); ++y) {
    for (int x = std::max(peak.x - kPeakReach, -h.reach); x <= std::min(peak.x + kPeakReach, h.reach); ++x) {
      const double w = std::pow(h.at(x, y) / peak.height, alpha);
      sum += w * Eigen::Vector2d(x, y);
      weight += w;
    }
  }
  return sum / weight;
}

Eigen::Matrix2d second_moment(const ShiftHistogram& h, const Eigen::Vector2d& centre) {
  Eigen::Matrix2d sum = Eigen::Matrix2d::Zero();
  double weight = 0.0;
  for (int y = -h.reach; y <= h.reach; ++y) {
    for (int x = -h.reach; x <= h.reach; ++x) {
      const Eigen::Vector2d off = Eigen::Vector2d(x, y) - centre;
      sum += h.at(x, y) * off * off.transpose();
      weight += h.at(x, y);
    }
  }
  return sum / weight;
}

Eigen::Isometry3d turned(const Eigen::Isometry3d& pose, double yaw) {
  Eigen::Isometry3d result = pose;
  result.linear() = Eigen::AngleAxisd(yaw, Eigen::Vector3d::UnitZ()) * pose.linear();
  return result;
}

/// The best direction of a level, and its shifts.
struct LevelResult {
  ShiftHistogram histogram;
  std::vector<ShiftScore> scores;
  double yaw = 0.0;         ///< [rad] from the pose that the level began with
  double yaw_stddev = 0.0;  ///< [rad]
  double lift = 0.0, coverage = 0.0, intensity_weight = 0.0;
};

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

std::vector<double> yaws_of(double range, double step) {
  std::vector<double> yaws;
  const int count = static_cast<int>(std::ceil(range / step - 1e-9));
  for (int i = -count; i <= count; ++i) yaws.push_back(i * step);
  return yaws;
}

template <class... Parts>
std::string sentence(const Parts&... parts) {
  std::ostringstream text;
  text.precision(3);
  (text << ... << parts);
  return text.str();
}

/// Of the scan's cells that have no ground, the share with such a cell of the map at or beside their place.
/// The road looks alike in all streets; walls and poles tell one from another.
double upright_share_of(const PyramidMap& map, const PointCloud& scan, const Eigen::Isometry3d& pose) {
  constexpr double kFewest = 50.0;  // [-] cells: with fewer, nothing stands there
  PyramidMap plan(map.level(0).cell_size(), map.origin());
  plan.add(transformed(scan, pose));
  double upright = 0.0, met = 0.0;
  for (std::size_t i = 0; i < plan.level(0).cells().size(); ++i) {
    if (plan.level(0).cells()[i].ground.count > 0.0) continue;
    upright += 1.0;
    const auto at = plan.level(0).place(i);
    bool found = false;
    for (int dy = -1; dy <= 1 && !found; ++dy) {
      for (int dx = -1; dx <= 1 && !found; ++dx) {
        const PyramidCell* there = map.level(0).find(at.x() + dx, at.y() + dy);
        found = there != nullptr && there->altitude.count > there->ground.count;
      }
    }
    met += found ? 1.0 : 0.0;
  }
  return upright < kFewest ? 1.0 : met / upright;
}

void judge_match(PyramidMatch& match, double mean_distance, double spread, const PyramidParam& param) {
  if (!(match.coverage >= param.min_coverage)) {
    match.reasons.push_back(
        sentence("the map knows only ", 100.0 * match.coverage, " % of the scan's cells"));
  }
  if (!(match.upright_share >= param.min_upright_share)) {
    match.reasons.push_back(sentence("only ", 100.0 * match.upright_share,
                                     " % of what stands on the ground stands there in the map"));
  }
  if (!(match.second_peak <= param.max_second_peak)) {
    match.reasons.push_back(
        sentence("two places are alike: the second has ", match.second_peak, " of the first's likelihood"));
  }
  if (!(mean_distance <= param.max_mean_distance)) {
    match.reasons.push_back(sentence("the scan does not look like the map: ", mean_distance,
                                     " squared standard deviations a cell"));
  }
  if (!(spread <= param.max_spread)) {
    match.reasons.push_back(sentence("the place is blurred: sigma_x times sigma_y is ", spread, " m^2"));
  }
  match.believed = match.reasons.empty();
}

}  // namespace

PyramidMatch match_pyramid(const PyramidMap& map, const PointCloud& scan, const Eigen::Isometry3d& guess,
                           const PyramidParam& param, const ShiftHistogram* prior) {
  PyramidMatch match;
  match.map_from_body = guess;
  match.covariance *= 100.0;
  if (scan.empty()) match.reasons.push_back("the source has no points");
  if (map.empty()) match.reasons.push_back("the target has no points");
  if (!match.reasons.empty()) return match;
  PyramidWeighing weighing = param.weighing;
  if (!scan.has_intensity() && weighing == PyramidWeighing::kFusion) weighing = PyramidWeighing::kAltitude;
  Eigen::Isometry3d pose = guess;
  LevelResult found;
  double range = param.yaw_range, mean_distance = 0.0;
  for (int level = PyramidMap::kLevels - 1; level >= 0; --level) {
    const double size = map.level(level).cell_size();
    const double least = param.intensity_share * spread_of_intensity(map.level(level));
    const double step = std::max(1e-4, level == 0 ? param.yaw_step : 0.5 * range);
    // Each finer level only mends the one before: half the reach, but for the last, whose peak must be clear.
    const int reach = level == 1 ? (param.reach + 1) / 2 : param.reach;
    const std::vector<double> yaws = range > 0.0 ? yaws_of(range, step) : std::vector<double>{0.0};
    if (level == 0 && weighing == PyramidWeighing::kFusion) {
      // A single sweep's intensity is that of its beams' rings: without a map between them it is a trap.
      PyramidMatch unused;
      const LevelResult there =
          search_level(map, 0, scan, pose, 0, {0.0}, PyramidWeighing::kAltitude, least, param, unused);
      if (there.coverage < param.min_coverage) {
        weighing = PyramidWeighing::kAltitude;
        match.remarks.push_back(sentence("the map knows only ", 100.0 * there.coverage,
                                         " % of the scan's cells: the intensity is left out"));
      }
    }
    found = search_level(map, level, scan, pose, reach, yaws, weighing, least, param, match);
    if (found.histogram.p.empty()) {  // not one cell of the scan is in reach of the map
      match.reasons.push_back("the map knows only 0 % of the scan's cells");
      return match;
    }
    found.histogram.cell_size = size;
    found.histogram.centre = pose.translation().head<2>();
    if (level == 0 && prior != nullptr && !prior->p.empty()) {
      double sum = 0.0;
      for (int y = -reach; y <= reach; ++y) {
        for (int x = -reach; x <= reach; ++x) {
          sum += found.histogram.at(x, y) *= prior->at(found.histogram.centre + size * Eigen::Vector2d(x, y));
        }
      }
      for (double& p : found.histogram.p)
        p = sum > 0.0 ? p / sum : 1.0 / static_cast<double>(found.histogram.p.size());
    }
    const Peak peak = highest(found.histogram);
    const Eigen::Vector2d centre =
        level == 0 ? centre_of(found.histogram, peak, param.sharpen) : Eigen::Vector2d(peak.x, peak.y);
    pose = turned(pose, found.yaw);
    pose.translation().head<2>() += size * centre;
    pose.translation().z() += found.lift;
    range = 0.5 * step;
    if (level > 0) continue;
    const Eigen::Matrix2d moment = size * size * second_moment(found.histogram, centre);
    match.second_peak = second_peak(found.histogram, peak);
    const ShiftScore& at_peak = found.scores[(peak.y + reach) * (2 * reach + 1) + peak.x + reach];
    mean_distance =
        found.intensity_weight * at_peak.intensity + (1.0 - found.intensity_weight) * at_peak.altitude;
    match.score = std::exp(-0.5 * mean_distance);
    match.covariance.setZero();
    match.covariance.topLeftCorner<2, 2>() =
        moment + param.min_stddev * param.min_stddev * Eigen::Matrix2d::Identity();
    match.covariance(2, 2) = kHeightStddev * kHeightStddev;
    match.covariance(3, 3) = match.covariance(4, 4) = kTiltStddev * kTiltStddev;
    match.covariance(5, 5) = found.yaw_stddev * found.yaw_stddev + step * step;
  }
  match.map_from_body = pose;
  match.coverage = found.coverage;
  match.intensity_weight = found.intensity_weight;
  match.histogram = found.histogram;
  match.upright_share = upright_share_of(map, scan, pose);
  const double spread = std::sqrt(match.covariance(0, 0) * match.covariance(1, 1));
  judge_match(match, mean_distance, spread, param);
  return match;
}

}  // namespace relative_map::core
