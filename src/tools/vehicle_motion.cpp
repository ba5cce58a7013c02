#include "vehicle_motion.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

namespace relative_map::core {

namespace {

constexpr double kWindow = 1.0;          // [s] before and after a pose, that its motion is taken from
constexpr std::size_t kLeast = 2;        // poses before and after, where they come more slowly
constexpr std::size_t kMost = 40;        // poses that are looked at, evenly, where there are more
constexpr double kLongestWindow = 5.0;   // [s] before and after, of these
constexpr double kSignificance = 5.0;    // standard deviations of a velocity that is no noise
constexpr double kLeastWay = 1.0;        // [m] that motion leads: less is a receiver's drift
constexpr double kSurely = 0.5;          // cosine of the angle between heading and motion that says which way
constexpr double kSidewaysShare = 0.02;  // of the moving poses, that bad headings may have
constexpr std::size_t kSidewaysPoses = 5;

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}

/// Poses of a time, as a motion at constant velocity.
struct Fit {
  Point2 position = Point2::Zero(), velocity = Point2::Zero();  ///< at the time 0
  double noise = 0.0;   ///< [m] of a pose's x and y, about a motion at constant acceleration
  double spread = 0.0;  ///< [s] the velocity's standard deviation is the noise divided by this
};

class Fitter {
 public:
  explicit Fitter(const std::vector<RecordedPose>& poses) : poses_(poses) {}

  /// In the order of the poses.
  Fit next(std::size_t i) {
    const double now = poses_[i].stamp;
    const std::size_t last = poses_.size() - 1;
    while (poses_[begin_].stamp < now - kWindow) ++begin_;
    while (end_ <= last && poses_[end_].stamp <= now + kWindow) ++end_;
    std::size_t begin = std::min(begin_, i - std::min<std::size_t>(1, i)),
                end = std::max(end_, std::min(i + 1, last) + 1);
    while (begin > 0 && i - begin < kLeast && now - poses_[begin - 1].stamp <= kLongestWindow) --begin;
    while (end <= last && end - i <= kLeast && poses_[end].stamp - now <= kLongestWindow) ++end;
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
  std::size_t begin_ = 0, end_ = 0;
};

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

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

void tell_reversing(const std::vector<RecordedPose>& poses, VehicleMotion& result) {
  const PoseMotion* before = nullptr;
  bool forward = true;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    PoseMotion& now = result.poses[i];
    if (now.motion == Motion::kStanding) continue;
    const double cosine = result.headings_used ? along(poses[i], now) : 0.0;
    if (std::abs(cosine) > kSurely) {
      forward = cosine > 0.0;
    } else if (before != nullptr && now.direction.dot(before->direction) < 0.0) {
      forward = !forward;  // no car turns about between two poses: it has changed gear
    }
    before = &now;
    now.motion = forward ? Motion::kForward : Motion::kReversing;
  }
}

}  // namespace

VehicleMotion find_motion(const std::vector<RecordedPose>& poses, double standing_speed) {
  VehicleMotion result;
  Fitter fitter(poses);
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
    PoseMotion motion{moves ? Motion::kForward : Motion::kStanding, fit.position, Point2::UnitX()};
    if (moves) motion.direction = fit.velocity / speed;
    result.poses.push_back(motion);
  }
  leave_out_drift(result);
  judge_headings(poses, result);
  tell_reversing(poses, result);
  return result;
}

}  // namespace relative_map::core
