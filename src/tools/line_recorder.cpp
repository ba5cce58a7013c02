#include "relative_map/tools/line_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "pose_outliers.hpp"
#include "vehicle_motion.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kAhead = 0.5;          // cosine of the angle between motion and the way to the next point
constexpr double kNotableNoise = 0.05;  // [m]

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}
Point2 position(const LinePoint& point) {
  return {point.x, point.y};
}

/// Leaves out the points that a reversing vehicle has come back over.
void take_back(const Point2& place, const Point2& direction, Recording& recording) {
  std::vector<LinePoint>& points = recording.line.points;
  while (!points.empty() && (position(points.back()) - place).dot(direction) < 0.0) {
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

std::string no_motion_fault(const Recording& recording) {
  std::ostringstream text;
  text << "the vehicle has not moved forward";
  if (recording.reversing > 0) text << ", but has reversed";
  if (recording.noise < kNotableNoise) return text.str();
  text.precision(2);
  text << ": all its positions lie within their noise, of a standard deviation of " << recording.noise
       << " m";
  return text.str();
}

/// The first of the poses that no line can be made of.
std::string fault_of(const std::vector<RecordedPose>& poses) {
  if (poses.empty()) return "there are no poses";
  for (std::size_t i = 0; i < poses.size(); ++i) {
    if (std::isfinite(poses[i].x) && std::isfinite(poses[i].y)) continue;
    return "pose " + std::to_string(i) + " has a position that is not finite";
  }
  return "";
}

void add_points(const std::vector<RecordedPose>& poses, const VehicleMotion& motion, double spacing,
                Recording& recording) {
  std::vector<LinePoint>& points = recording.line.points;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RecordedPose& pose = poses[i];
    const PoseMotion& now = motion.poses[i];
    switch (now.motion) {
      case Motion::kStanding:
        ++recording.standing;
        break;
      case Motion::kReversing:
        ++recording.reversing;
        take_back(position(poses[0]) + now.position, now.direction, recording);
        break;
      case Motion::kForward: {
        const Point2 way = points.empty() ? Point2(Point2::Zero()) : position(pose) - position(points.back());
        // Noise must not lead the line back.
        const bool next = way.norm() >= spacing - 1e-6 && way.dot(now.direction) >= kAhead * way.norm();
        if (points.empty() || next) points.push_back({pose.x, pose.y, pose.z, kNaN, kNaN, kNaN, kNaN});
      }
    }
  }
}

}  // namespace

Recording record_line(const std::vector<RecordedPose>& recorded, const RecorderParam& param) {
  Recording recording;
  recording.fault = fault_of(recorded);
  if (!recording.fault.empty()) return recording;
  recording.outliers = find_outliers(recorded);
  const std::vector<RecordedPose> poses = without(recorded, recording.outliers);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    if ((position(poses[i]) - position(poses[i - 1])).norm() <= param.max_jump) continue;
    recording.fault = jump_fault(poses[i - 1], poses[i]);
    return recording;
  }
  const VehicleMotion motion = find_motion(poses, param.standing_speed);
  recording.noise = motion.noise;
  recording.moving = motion.moving;
  recording.sideways = motion.sideways;
  recording.headings_used = motion.headings_used;
  add_points(poses, motion, param.spacing, recording);
  if (recording.line.points.size() < 2) recording.fault = no_motion_fault(recording);
  return recording;
}

}  // namespace relative_map::core
