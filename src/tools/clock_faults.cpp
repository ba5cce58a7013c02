#include "relative_map/tools/clock_faults.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "relative_map/geometry/pose2.hpp"
#include "relative_map/geometry/statistics.hpp"

namespace relative_map::core {

namespace {

constexpr double kLatest = 10.0;           // [s] that a message comes late and not by another clock
constexpr double kAhead = 5.0;             // [s] that the stamps run ahead of the time that passed
constexpr std::size_t kAround = 5;         // poses before and after a step, that tell whether it stays
constexpr std::size_t kStandingPoses = 3;  // with one and the same stamp, at different places
constexpr double kSamePlace = 1e-6;        // [m]
constexpr double kSameTime = 0.25;         // of the usual time between poses
constexpr std::size_t kReach = 3;          // poses before and after, in which two ways are told apart
constexpr std::size_t kLeastRun = 6;       // poses by turns: fewer are outliers
constexpr double kApart = 0.3;             // [m] of two ways
constexpr double kByNoise = 4.0;           // times the noise of each way

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}

/// [s] of a message on its way, by the clocks of both ends.
double latency(const RecordedPose& pose) {
  return pose.received - pose.stamp;
}

class ClockMender {
 public:
  explicit ClockMender(std::vector<RecordedPose>& poses) : given_(poses), poses_(poses) {
    std::vector<double> periods;
    for (std::size_t i = 1; i < given_.size(); ++i) {
      const double passed = given_[i].received - given_[i - 1].received;
      if (passed > 0.0) periods.push_back(passed);
    }
    if (!periods.empty()) usual_period_ = median(std::move(periods));
  }

  std::vector<ClockStep> run() {
    double shift = 0.0;
    for (std::size_t i = 1; i < given_.size(); ++i) {
      const double last = poses_[i - 1].stamp;
      if (stands(i)) {
        if (!standing_) steps_.push_back({i, given_[i].stamp, 0.0});
        standing_ = true;
      } else if (!standing_ && !is_set(i)) {
        poses_[i].stamp = given_[i].stamp + shift;
        continue;
      } else if (!standing_) {
        steps_.push_back({i, given_[i].stamp, given_[i].stamp - given_[i - 1].stamp - passed(i)});
      } else {
        standing_ = false;
      }
      poses_[i].stamp = last + passed(i);
      shift = poses_[i].stamp - given_[i].stamp;
    }
    return std::move(steps_);
  }

 private:
  /// [s] since the pose before, by the clock of the receiving end; that may have been set back as well.
  double passed(std::size_t i) const {
    const double passed = given_[i].received - given_[i - 1].received;
    return passed >= 0.0 ? passed : usual_period_;
  }

  /// In the middle of some poses that have the same stamp, though the vehicle moves.
  bool stands(std::size_t i) const {
    if (given_[i].stamp != given_[i - 1].stamp || !(passed(i) > 0.0)) return false;
    std::size_t begin = i, end = i, moves = 0;
    while (begin > 0 && i - begin < kStandingPoses && given_[begin - 1].stamp == given_[i].stamp) --begin;
    while (end + 1 < given_.size() && end - i < kStandingPoses && given_[end + 1].stamp == given_[i].stamp)
      ++end;
    for (std::size_t k = begin + 1; k <= end; ++k) {
      moves += (position(given_[k]) - position(given_[k - 1])).norm() > kSamePlace;
    }
    return moves >= kStandingPoses;
  }

  /// Whether the clock was set before this pose, and the pose did not just come late.
  bool is_set(std::size_t i) const {
    const double step = given_[i].stamp - given_[i - 1].stamp, ahead = step - passed(i);
    if (step < -kLatest || ahead > kLatest) return true;
    if (step >= 0.0 && ahead <= kAhead) return false;
    if (given_[i].received < given_[i - 1].received) return true;  // the receiving end's clock was set, too
    // A clock that was set stays so for those that follow; a late pose is followed by others in time.
    std::vector<double> before, after;
    for (std::size_t k = i - std::min(i, kAround); k < i; ++k) before.push_back(latency(given_[k]));
    for (std::size_t k = i + 1; k < std::min(i + 1 + kAround, given_.size()); ++k) {
      after.push_back(latency(given_[k]));
    }
    if (after.empty()) return false;
    const double change = median(std::move(after)) - median(std::move(before));
    return -change / ahead > 0.5;
  }

  const std::vector<RecordedPose> given_;
  std::vector<RecordedPose>& poses_;
  std::vector<ClockStep> steps_;
  double usual_period_ = 0.0;  ///< [s]
  bool standing_ = false;
};

/// [m] from the place between two others, by their times.
double deviation(const RecordedPose& before, const RecordedPose& pose, const RecordedPose& after) {
  const double whole = after.stamp - before.stamp;
  const double share = whole > 0.0 ? (pose.stamp - before.stamp) / whole : 0.5;
  return (position(pose) - position(before) - share * (position(after) - position(before))).norm();
}

/// Two poses of the same time may come in either order: the one that goes on from the last but one comes
/// first, so that two ways by turns stay by turns.
std::vector<RecordedPose> by_turns(std::vector<RecordedPose> poses) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if (poses[i].stamp > poses[i - 1].stamp) periods.push_back(poses[i].stamp - poses[i - 1].stamp);
  }
  const double same_time = kSameTime * median(std::move(periods));
  for (std::size_t i = 2; i + 1 < poses.size(); ++i) {
    if (!(poses[i + 1].stamp - poses[i].stamp < same_time)) continue;
    const Point2 last = position(poses[i - 2]);
    if ((position(poses[i + 1]) - last).norm() < (position(poses[i]) - last).norm()) {
      std::swap(poses[i], poses[i + 1]);
    }
    ++i;
  }
  return poses;
}

}  // namespace

std::vector<ClockStep> mend_clock(std::vector<RecordedPose>& poses) {
  std::vector<ClockStep> steps;
  const bool timed = std::all_of(poses.begin(), poses.end(),
                                 [](const RecordedPose& pose) { return std::isfinite(pose.received); });
  if (timed) steps = ClockMender(poses).run();
  std::stable_sort(poses.begin(), poses.end(),
                   [](const RecordedPose& a, const RecordedPose& b) { return a.stamp < b.stamp; });
  return steps;
}

std::vector<TwoSources> find_two_sources(const std::vector<RecordedPose>& by_stamp) {
  std::vector<TwoSources> found;
  const std::vector<RecordedPose> poses = by_turns(by_stamp);
  const std::size_t count = poses.size();
  if (count < 2 * kReach + 5) return found;
  std::vector<double> from_next(count, 0.0), from_next_but_one(count, 0.0);
  for (std::size_t i = 2; i + 2 < count; ++i) {
    from_next[i] = deviation(poses[i - 1], poses[i], poses[i + 1]);
    from_next_but_one[i] = deviation(poses[i - 2], poses[i], poses[i + 2]);
  }
  std::size_t run = 0;
  double apart = 0.0;
  for (std::size_t i = 2 + kReach; i + 2 + kReach < count; ++i) {
    const auto around = [&](const std::vector<double>& values) {
      const auto at = values.begin() + static_cast<std::ptrdiff_t>(i);
      return median(std::vector<double>(at - kReach, at + kReach + 1));
    };
    const double between = around(from_next);
    const bool by_turns = between > kApart + kByNoise * around(from_next_but_one);
    apart = by_turns ? std::max(run > 0 ? apart : 0.0, between) : apart;
    run = by_turns ? run + 1 : 0;
    if (run == kLeastRun) found.push_back({poses[i + 1 - run].stamp, poses[i].stamp, apart});
    if (run > kLeastRun) found.back() = {found.back().from, poses[i].stamp, apart};
  }
  return found;
}

}  // namespace relative_map::core
