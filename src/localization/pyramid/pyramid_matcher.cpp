#include "relative_map/localization/pyramid/pyramid_matcher.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "pyramid_level_search.hpp"
#include "relative_map/localization/clouds/cloud_filters.hpp"

namespace relative_map::core {

namespace {

constexpr int kPeakReach = 3;          // [-] cells around a peak that belong to it
constexpr double kTiltStddev = 0.01;   // [rad] of roll and pitch, which are the guess's
constexpr double kHeightStddev = 0.1;  // [m] of z, which is the ground's

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
