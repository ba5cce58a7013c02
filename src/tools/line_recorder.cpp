#include "relative_map/tools/line_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "relative_map/geometry/pose2.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kWindow = 1.0;  // [s] before and after a pose, that its motion is taken from
constexpr double kSurely = 0.5;  // cosine of the angle between heading and motion that says which way

enum class Motion { kStanding, kForward, kReversing };

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}

/// Says for each pose how the vehicle moves, from the poses around it.
class MotionFinder {
 public:
  MotionFinder(const std::vector<RecordedPose>& poses, const RecorderParam& param)
      : poses_(poses), origin_(position(poses[0])), param_(param) {
    sums_.emplace_back(0.0, 0.0);
    for (const RecordedPose& pose : poses) sums_.push_back(sums_.back() + position(pose) - origin_);
  }

  /// In the order of the poses.
  Motion next(std::size_t i) {
    const double now = poses_[i].stamp;
    while (poses_[begin_].stamp < now - kWindow) ++begin_;
    while (end_ < poses_.size() && poses_[end_].stamp <= now + kWindow) ++end_;
    const Point2 velocity = velocity_over(begin_, end_);
    if (!(velocity.norm() > param_.standing_speed)) return Motion::kStanding;
    const Point2 direction = velocity.normalized();
    const double heading = poses_[i].heading;
    const double along = std::isfinite(heading) ? direction.dot(Pose2({}, heading).forward()) : 0.0;
    if (std::abs(along) > kSurely) {
      forward_ = along > 0.0;
    } else if (moved_ && direction.dot(last_direction_) < 0.0) {
      forward_ = !forward_;  // no car turns about between two poses: it has changed gear
    }
    moved_ = true;
    last_direction_ = direction;
    return forward_ ? Motion::kForward : Motion::kReversing;
  }

 private:
  /// Between the means of the first and the last third, which noise has little to do with.
  Point2 velocity_over(std::size_t begin, std::size_t end) const {
    const std::size_t third = std::max<std::size_t>(1, (end - begin) / 3);
    if (end - begin < 2) return Point2::Zero();
    const auto mean = [&](std::size_t from, std::size_t to) -> Point2 {
      return (sums_[to] - sums_[from]) / static_cast<double>(to - from);
    };
    const auto mean_stamp = [&](std::size_t from, std::size_t to) {
      return 0.5 * (poses_[from].stamp + poses_[to - 1].stamp);
    };
    const double time = mean_stamp(end - third, end) - mean_stamp(begin, begin + third);
    if (!(time > 0.0)) return Point2::Zero();
    return (mean(end - third, end) - mean(begin, begin + third)) / time;
  }

  const std::vector<RecordedPose>& poses_;
  Point2 origin_;
  const RecorderParam& param_;
  std::vector<Point2> sums_;  ///< of positions, before each pose
  std::size_t begin_ = 0, end_ = 0;
  bool forward_ = true, moved_ = false;
  Point2 last_direction_ = Point2::UnitX();
};

/// Leaves out the points that a reversing vehicle has come back over.
void take_back(const RecordedPose& pose, const Point2& backward, Recording& recording) {
  std::vector<LinePoint>& points = recording.line.points;
  while (!points.empty() && (Point2(points.back().x, points.back().y) - position(pose)).dot(backward) < 0.0) {
    points.pop_back();
    ++recording.taken_back;
  }
}

std::string jump_fault(const RecordedPose& before, const RecordedPose& after) {
  std::ostringstream text;
  text.precision(10);
  text << "the position jumps by " << (position(after) - position(before)).norm() << " m at stamp "
       << std::fixed << after.stamp << ": has the map frame changed, its zone or its origin?";
  return text.str();
}

}  // namespace

Recording record_line(const std::vector<RecordedPose>& poses, const RecorderParam& param) {
  Recording recording;
  if (poses.empty()) {
    recording.fault = "there are no poses";
    return recording;
  }
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (!std::isfinite(poses[i].x) || !std::isfinite(poses[i].y)) {
      recording.fault = "pose " + std::to_string(i) + " has a position that is not finite";
      return recording;
    }
    if (i > 0 && (position(poses[i]) - position(poses[i - 1])).norm() > param.max_jump) {
      recording.fault = jump_fault(poses[i - 1], poses[i]);
      return recording;
    }
  }
  MotionFinder finder(poses, param);
  std::vector<LinePoint>& points = recording.line.points;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RecordedPose& pose = poses[i];
    switch (finder.next(i)) {
      case Motion::kStanding:
        ++recording.standing;
        break;
      case Motion::kReversing: {
        ++recording.reversing;
        const Point2 moved = i > 0 ? Point2(position(pose) - position(poses[i - 1])) : Point2(Point2::Zero());
        take_back(pose, moved, recording);
        break;
      }
      case Motion::kForward: {
        const bool far =
            points.empty() ||
            (position(pose) - Point2(points.back().x, points.back().y)).norm() >= param.spacing - 1e-6;
        if (far) points.push_back({pose.x, pose.y, pose.z, kNaN, kNaN, kNaN, kNaN});
      }
    }
  }
  if (points.size() < 2) recording.fault = "the vehicle has not moved forward";
  return recording;
}

}  // namespace relative_map::core
