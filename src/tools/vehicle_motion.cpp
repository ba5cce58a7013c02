#include "vehicle_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "relative_map/geometry/statistics.hpp"

namespace relative_map::core {

namespace {

constexpr std::size_t kLeast = 2;        // poses before and after, where they come more slowly
constexpr std::size_t kMost = 40;        // poses that are looked at, evenly, where there are more
constexpr double kLongestWindow = 5.0;   // [s] before and after, of these, where the window is not longer
constexpr double kSignificance = 5.0;    // standard deviations of a velocity that is no noise
constexpr double kLeastWay = 1.0;        // [m] that motion leads: less is a receiver's drift
constexpr double kSurely = 0.5;          // cosine of the angle between heading and motion that says which way
constexpr double kSidewaysShare = 0.02;  // of the moving poses, that bad headings may have
constexpr std::size_t kSidewaysPoses = 5;
constexpr double kAbout = 0.5;       // cosine: ways that lead more against each other than this are reversed
constexpr double kLegLength = 2.0;   // [m] of these ways, at most
constexpr double kLeastLeg = 0.5;    // [m] shorter ones lead nowhere
constexpr double kLegByNoise = 4.0;  // standard deviations that they must be longer than

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}

/// Poses of a time, as a motion at constant velocity.
struct Fit {
  Point2 position = Point2::Zero(), velocity = Point2::Zero();  ///< at the time 0
  double noise = 0.0;   ///< [m] of a pose's x and y, about a motion at constant acceleration
  double spread = 0.0;  ///< [s] the velocity's standard deviation is the noise divided by this
  double count = 1.0;   ///< poses
};

class Fitter {
 public:
  Fitter(const std::vector<RecordedPose>& poses, double window)
      : poses_(poses), window_(window), longest_window_(std::max(window, kLongestWindow)) {}

  /// In the order of the poses.
  Fit next(std::size_t i) {
    const double now = poses_[i].stamp;
    const std::size_t last = poses_.size() - 1;
    while (poses_[begin_].stamp < now - window_) ++begin_;
    while (end_ <= last && poses_[end_].stamp <= now + window_) ++end_;
    std::size_t begin = std::min(begin_, i - std::min<std::size_t>(1, i)),
                end = std::max(end_, std::min(i + 1, last) + 1);
    while (begin > 0 && i - begin < kLeast && now - poses_[begin - 1].stamp <= longest_window_) --begin;
    while (end <= last && end - i <= kLeast && poses_[end].stamp - now <= longest_window_) ++end;
    return fit(i, begin, end);
  }

 private:
  Fit fit(std::size_t at, std::size_t begin, std::size_t end) const {
    Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
    Eigen::Matrix<double, 3, 2> right = Eigen::Matrix<double, 3, 2>::Zero();
    double squares = 0.0;
    const std::size_t step = 1 + (end - begin) / kMost;
    for (std::size_t i = begin; i < end; i += step) {
      const double t = poses_[i].stamp - poses_[at].stamp;
      const Eigen::Vector3d powers(1.0, t, t * t);
      const Point2 offset = position(poses_[i]) - position(poses_[at]);
      normal += powers * powers.transpose();
      right += powers * offset.transpose();
      squares += offset.squaredNorm();
    }
    Fit result;
    result.count = normal(0, 0);
    const double count = normal(0, 0), mean_time = normal(0, 1) / count;
    const Point2 mean = right.row(0).transpose() / count;
    const double square_spread = normal(1, 1) - count * mean_time * mean_time;
    if (square_spread > 1e-9) {
      result.spread = std::sqrt(square_spread);
      result.velocity = (right.row(1).transpose() - count * mean_time * mean) / square_spread;
    }
    result.position = position(poses_[at]) - position(poses_[0]) + mean - mean_time * result.velocity;
    if (count > 3.0) {
      const Eigen::Matrix<double, 3, 2> quadratic = normal.ldlt().solve(right);
      const double rest = squares - (quadratic.transpose() * right).trace();
      result.noise = std::sqrt(std::max(0.0, rest) / (2.0 * (count - 3.0)));
    }
    return result;
  }

  const std::vector<RecordedPose>& poses_;
  double window_, longest_window_;  ///< [s]
  std::size_t begin_ = 0, end_ = 0;
};

/// A run of poses that seem to move is motion if it leads somewhere.
void leave_out_drift(VehicleMotion& result) {
  std::vector<PoseMotion>& poses = result.poses;
  for (std::size_t i = 0; i < poses.size();) {
    std::size_t end = i;
    double way = 0.0;
    for (; end < poses.size() && poses[end].motion != Motion::kStanding; ++end) {
      way = std::max(way, (poses[end].position - poses[i].position).norm());
    }
    for (std::size_t k = i; k < end && way < kLeastWay; ++k) poses[k].motion = Motion::kStanding;
    if (way >= kLeastWay) result.moving += end - i;
    i = std::max(end, i + 1);
  }
}

/// Of the angle between heading and motion; 0 where there is none.
double along(const RecordedPose& pose, const PoseMotion& motion) {
  return std::isfinite(pose.heading) ? motion.direction.dot(Pose2({}, pose.heading).forward()) : 0.0;
}

void judge_headings(const std::vector<RecordedPose>& poses, VehicleMotion& result) {
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (result.poses[i].motion == Motion::kStanding || !std::isfinite(poses[i].heading)) continue;
    if (std::abs(along(poses[i], result.poses[i])) <= kSurely) ++result.sideways;
  }
  const double limit = kSidewaysShare * static_cast<double>(result.moving);
  result.headings_used = result.sideways <= kSidewaysPoses || static_cast<double>(result.sideways) <= limit;
}

/// Where a way leads from (`step` -1: to) a pose, over a few metres.
Point2 leg(const std::vector<PoseMotion>& poses, std::size_t from, std::ptrdiff_t step) {
  Point2 way = Point2::Zero();
  for (auto i = static_cast<std::ptrdiff_t>(from); i >= 0 && i < static_cast<std::ptrdiff_t>(poses.size());
       i += step) {
    const Point2 here = poses[static_cast<std::size_t>(i)].position - poses[from].position;
    if (here.norm() > way.norm()) way = here;
    if (way.norm() > kLegLength) break;
    if (here.norm() < 0.5 * way.norm()) break;  // it comes back: the next change of gear
  }
  return static_cast<double>(step) * way;
}

/// No car turns about on the spot: where the ways before and after lead against each other, it has changed
/// gear. One direction of noise, or a sharp corner, is no such place.
bool turns_about(const std::vector<PoseMotion>& poses, std::size_t before, std::size_t after) {
  const Point2 to = leg(poses, before, -1), from = leg(poses, after, 1);
  const double least = std::max(kLeastLeg, kLegByNoise * (poses[before].deviation + poses[after].deviation));
  return to.norm() > least && from.norm() > least && to.dot(from) < -kAbout * to.norm() * from.norm();
}

void tell_reversing(const std::vector<RecordedPose>& poses, VehicleMotion& result) {
  std::size_t before = poses.size();  // none yet
  bool forward = true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    PoseMotion& now = result.poses[i];
    if (now.motion == Motion::kStanding) continue;
    const double cosine = result.headings_used ? along(poses[i], now) : 0.0;
    if (std::abs(cosine) > kSurely) {
      forward = cosine > 0.0;
    } else if (before < poses.size() && now.direction.dot(result.poses[before].direction) < 0.0 &&
               turns_about(result.poses, before, i)) {
      forward = !forward;
    }
    before = i;
    now.motion = forward ? Motion::kForward : Motion::kReversing;
  }
}

}  // namespace

VehicleMotion find_motion(const std::vector<RecordedPose>& poses, double standing_speed, double window) {
  VehicleMotion result;
  Fitter fitter(poses, window);
  std::vector<Fit> fits;
  std::vector<double> noises;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    fits.push_back(fitter.next(i));
    noises.push_back(fits.back().noise);
  }
  result.noise = median(noises);
  for (const Fit& fit : fits) {
    const double speed = fit.velocity.norm();
    // By a few poses alone, noise may look small.
    const double noise = std::max(fit.noise, result.noise);
    const bool moves = speed > standing_speed && speed * fit.spread > kSignificance * noise;
    PoseMotion motion{moves ? Motion::kForward : Motion::kStanding, fit.position, Point2::UnitX(), noise,
                      noise / std::sqrt(fit.count)};
    if (moves) motion.direction = fit.velocity / speed;
    result.poses.push_back(motion);
  }
  leave_out_drift(result);
  judge_headings(poses, result);
  tell_reversing(poses, result);
  return result;
}

}  // namespace relative_map::core
