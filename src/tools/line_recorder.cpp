#include "relative_map/tools/line_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <limits>
#include <sstream>
#include <utility>

#include "pose_outliers.hpp"
#include "relative_map/geometry/statistics.hpp"
#include "relative_map/tools/clock_faults.hpp"
#include "vehicle_motion.hpp"

namespace relative_map::core {

namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kAhead = 0.5;          // cosine of the angle between motion and the way to the next point
constexpr double kNotableNoise = 0.05;  // [m]
constexpr double kFastest = 70.0;       // [m/s] of a car: farther apart by time is a jump, and no gap
constexpr double kJumpByNoise = 8.0;    // usual deviations: less is noise
constexpr double kBesideBack =
    2.0;  // [m] more than it reversed by, that a point may lie from where it is taken back
constexpr double kAnchor = 2.0;         // [m] of the steps that a way is measured by, at least
constexpr double kAnchorByNoise = 6.0;  // standard deviations of a position that they are longer than
constexpr double kSilence = 2.0;        // [s] without poses that the way is lost in, at least
constexpr double kSilentPeriods = 4.0;  // usual times between poses, likewise
constexpr double kLeastShare = 0.5;     // of the way: less is no recording of it
constexpr double kGoodShare = 0.9;      // of the way: with less, motion is looked for over a longer time
constexpr double kNotableWay = 20.0;    // [m] lost: less is a matter of starts and stops
constexpr double kLongestWindow = 8.0;  // [s] before and after a pose, in which slow motion is looked for

Point2 position(const RecordedPose& pose) {
  return {pose.x, pose.y};
}
Point2 position(const LinePoint& point) {
  return {point.x, point.y};
}

/// Leaves out the points that a reversing vehicle has come back over, by `reversed` [m].
void take_back(const Point2& place, const Point2& direction, double reversed, Recording& recording) {
  std::vector<LinePoint>& points = recording.line.points;
  while (!points.empty()) {
    const Point2 way = position(points.back()) - place;
    if (way.dot(direction) >= 0.0 || way.norm() > reversed + kBesideBack) return;
    points.pop_back();
    ++recording.taken_back;
  }
}

std::string jump_fault(const RecordedPose& before, const RecordedPose& after) {
  std::ostringstream text;
  text.precision(10);
  text << "the position jumps by " << (position(after) - position(before)).norm() << " m at stamp "
       << std::fixed << after.stamp << ": has the map frame changed, its zone or its origin";
  const double silence = after.stamp - before.stamp;
  if (silence > kSilence)
    text << std::setprecision(1) << ", or was a clock set, " << silence << " s after the pose before";
  text << "?";
  return text.str();
}

/// Between a pose and the one before.
bool jumps(const std::vector<RecordedPose>& poses, std::size_t i, double max_jump) {
  const double distance = (position(poses[i]) - position(poses[i - 1])).norm();
  if (distance <= max_jump || distance <= kFastest * (poses[i].stamp - poses[i - 1].stamp)) return false;
  return distance > kJumpByNoise * usual_deviation(poses, i);
}

std::string two_sources_fault(const TwoSources& sources) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(1) << "the poses lie on two ways by turns, some " << sources.apart
       << " m apart, from stamp " << sources.from << " to " << sources.to
       << ": there are two sources on one topic, or the clock of the recording was set back";
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

void add_points(const std::vector<RecordedPose>& poses, const VehicleMotion& motion,
                const RecorderParam& param, Recording& recording) {
  std::vector<LinePoint>& points = recording.line.points;
  double reversed = 0.0;  // [m] since it went forward
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const RecordedPose& pose = poses[i];
    const PoseMotion& now = motion.poses[i];
    if (now.noise > param.max_noise) {
      ++recording.scattered;
      continue;
    }
    switch (now.motion) {
      case Motion::kStanding:
        ++recording.standing;
        break;
      case Motion::kReversing:
        ++recording.reversing;
        if (i > 0) reversed += (now.position - motion.poses[i - 1].position).norm();
        take_back(position(poses[0]) + now.position, now.direction, reversed, recording);
        break;
      case Motion::kForward: {
        reversed = 0.0;
        const Point2 way = points.empty() ? Point2(Point2::Zero()) : position(pose) - position(points.back());
        // Noise must not lead the line back.
        const bool next = way.norm() >= param.spacing - 1e-6 && way.dot(now.direction) >= kAhead * way.norm();
        if (points.empty() || next) points.push_back({pose.x, pose.y, pose.z, kNaN, kNaN, kNaN, kNaN});
      }
    }
  }
}

/// [s] between poses that is a silence.
double silence_of(const std::vector<RecordedPose>& poses) {
  std::vector<double> periods;
  for (std::size_t i = 1; i < poses.size(); ++i) periods.push_back(poses[i].stamp - poses[i - 1].stamp);
  return std::max(kSilence, periods.empty() ? 0.0 : kSilentPeriods * median(std::move(periods)));
}

/// The way from anchor to anchor, which lie so far apart that noise makes it hardly longer; each step is of
/// the kind that most of its poses are.
WayShares measure_way(const std::vector<RecordedPose>& poses, const VehicleMotion& motion, double max_noise) {
  WayShares way;
  const double silence = silence_of(poses);
  std::size_t anchor = 0, kept = 0, reversed = 0;
  bool silent = false;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    const PoseMotion &from = motion.poses[anchor], &now = motion.poses[i];
    kept += now.motion == Motion::kForward && now.noise <= max_noise;
    reversed += now.motion == Motion::kReversing;
    silent = silent || poses[i].stamp - poses[i - 1].stamp > silence;
    const double step = (now.position - from.position).norm();
    if (step < std::max(kAnchor, kAnchorByNoise * std::max(from.deviation, now.deviation))) continue;
    const std::size_t half = (i - anchor + 1) / 2;
    (silent ? way.lost : reversed >= half ? way.reversed : kept >= half ? way.kept : way.lost) += step;
    anchor = i;
    kept = reversed = 0;
    silent = false;
  }
  return way;
}

/// A recording by motion that shows within `window` [s] before and after a pose.
Recording record_by(const std::vector<RecordedPose>& poses, const RecorderParam& param, double window) {
  Recording recording;
  const VehicleMotion motion = find_motion(poses, param.standing_speed, window);
  recording.noise = motion.noise;
  recording.moving = motion.moving;
  recording.sideways = motion.sideways;
  recording.headings_used = motion.headings_used;
  recording.way = measure_way(poses, motion, param.max_noise);
  add_points(poses, motion, param, recording);
  return recording;
}

bool misses_much(const WayShares& way, double share) {
  return way.lost > kNotableWay && way.share() < share;
}

/// Slow motion needs time to show through noise: a longer window is taken where it keeps more of the way.
Recording record_by_any(const std::vector<RecordedPose>& poses, const RecorderParam& param) {
  Recording best = record_by(poses, param, 1.0);
  for (double window = 2.0; window <= kLongestWindow && misses_much(best.way, kGoodShare); window *= 2.0) {
    Recording next = record_by(poses, param, window);
    if (next.way.share() > best.way.share()) best = std::move(next);
  }
  return best;
}

std::string too_little_fault(const Recording& recording) {
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << "only " << recording.way.kept << " of "
       << recording.way.kept + recording.way.lost << " m of the way (" << 100.0 * recording.way.share()
       << " %) can become a line: the poses scatter by a standard deviation of " << std::setprecision(2)
       << recording.noise << " m";
  if (recording.doubtful > 0) {
    text << ", and " << recording.doubtful << " are left out that are stated to be worse than the limit";
  }
  return text.str();
}

}  // namespace

Recording record_line(const std::vector<RecordedPose>& recorded, const RecorderParam& param) {
  Recording recording;
  recording.fault = fault_of(recorded);
  if (!recording.fault.empty()) return recording;
  std::vector<RecordedPose> poses = recorded;
  poses.erase(std::remove_if(poses.begin(), poses.end(),
                             [&](const RecordedPose& pose) { return pose.deviation > param.max_noise; }),
              poses.end());
  const std::size_t doubtful = recorded.size() - poses.size();
  if (poses.empty()) {
    recording.fault =
        "all of its " + std::to_string(doubtful) + " poses are stated to be worse than the limit";
    return recording;
  }
  const std::vector<PoseOutlier> outliers = find_outliers(poses);
  poses = without(poses, outliers);
  const std::vector<TwoSources> sources = find_two_sources(poses);
  if (!sources.empty()) recording.fault = two_sources_fault(sources.front());
  for (std::size_t i = 1; i < poses.size() && recording.fault.empty(); ++i) {
    if (jumps(poses, i, param.max_jump)) recording.fault = jump_fault(poses[i - 1], poses[i]);
  }
  if (recording.fault.empty()) recording = record_by_any(poses, param);
  recording.outliers = outliers;
  recording.doubtful = doubtful;
  if (!recording.fault.empty()) return recording;
  if (misses_much(recording.way, kLeastShare)) {
    recording.fault = too_little_fault(recording);
  } else if (recording.line.points.size() < 2) {
    recording.fault = no_motion_fault(recording);
  }
  return recording;
}

}  // namespace relative_map::core
