#include "pose_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/geometry/statistics.hpp"

namespace relative_map::core {

namespace {

constexpr double kAcceleration = 10.0;     // [m/s^2] that no road vehicle exceeds
constexpr double kLeastDeviation = 5.0;    // [m] of an outlier from its neighbours
constexpr double kByNoise = 10.0;          // times the usual deviation
constexpr double kNeighboursShare = 0.7;   // a single outlier makes its neighbours deviate by half as much
constexpr std::size_t kAround = 12;        // poses before and after one, that tell what is usual there
constexpr double kNextButOneShare = 0.25;  // and those beyond them not at all

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}

/// How far a pose lies from where its neighbours put it.
struct Deviation {
  double distance = 0.0;  ///< [m]
  double allowed = 0.0;   ///< [m] that acceleration explains
};

std::vector<Deviation> deviations_of(const std::vector<RecordedPose>& poses) {
  std::vector<Deviation> result(poses.size());
  for (std::size_t i = 1; i + 1 < poses.size(); ++i) {
    const double before = poses[i].stamp - poses[i - 1].stamp, after = poses[i + 1].stamp - poses[i].stamp;
    const double weight = before + after > 0.0 ? before / (before + after) : 0.5;
    const Point2 a = position(poses[i - 1]), b = position(poses[i + 1]);
    result[i] = {(position(poses[i]) - a - weight * (b - a)).norm(), 0.5 * kAcceleration * before * after};
  }
  return result;
}

double usual(const std::vector<Deviation>& deviations) {
  std::vector<double> distances;
  for (const Deviation& deviation : deviations) distances.push_back(deviation.distance);
  return median(std::move(distances));
}

}  // namespace

std::vector<PoseOutlier> find_outliers(const std::vector<RecordedPose>& poses) {
  std::vector<PoseOutlier> outliers;
  if (poses.size() < 4) return outliers;
  const std::vector<Deviation> all = deviations_of(poses);
  const double limit = std::max(kLeastDeviation, kByNoise * usual(all));
  const std::size_t last = poses.size() - 1;
  const auto farther_than = [&](std::size_t i, double least) {
    return all[i].distance > least + all[i].allowed;
  };
  // The first and the last pose show in the one beside them, by half.
  const auto at_tip = [&](std::size_t beside, std::size_t beyond) {
    return farther_than(beside, 0.5 * limit) &&
           all[beyond].distance < kNextButOneShare * all[beside].distance;
  };
  const bool first_is = at_tip(1, 2), last_is = at_tip(last - 1, last - 2);
  if (first_is) outliers.push_back({0, poses[0].stamp, 2.0 * all[1].distance});
  for (std::size_t i = first_is ? 2 : 1; i < (last_is ? last - 1 : last); ++i) {
    const double beside = std::max(all[i - 1].distance, all[i + 1].distance);
    // After a step that stays both its sides deviate alike.
    if (farther_than(i, limit) && beside < kNeighboursShare * all[i].distance) {
      outliers.push_back({i, poses[i].stamp, all[i].distance});
    }
  }
  if (last_is) outliers.push_back({last, poses[last].stamp, 2.0 * all[last - 1].distance});
  return outliers;
}

double usual_deviation(const std::vector<RecordedPose>& poses, std::size_t pose) {
  const auto at = poses.begin() + static_cast<std::ptrdiff_t>(pose);
  const auto begin = at - static_cast<std::ptrdiff_t>(std::min(pose, kAround));
  const auto end = at + static_cast<std::ptrdiff_t>(std::min(kAround, poses.size() - pose));
  double greater = 0.0;
  for (const std::vector<RecordedPose>& side : {std::vector(begin, at), std::vector(at, end)}) {
    if (side.size() < 3) continue;
    const std::vector<Deviation> all = deviations_of(side);
    greater = std::max(greater, usual({all.begin() + 1, all.end() - 1}));  // the first and last have none
  }
  return greater;
}

std::vector<RecordedPose> without(const std::vector<RecordedPose>& poses,
                                  const std::vector<PoseOutlier>& outliers) {
  std::vector<RecordedPose> kept;
  auto next = outliers.begin();
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (next != outliers.end() && next->pose == i) {
      ++next;
    } else {
      kept.push_back(poses[i]);
    }
  }
  return kept;
}

}  // namespace relative_map::core
