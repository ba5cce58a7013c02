#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <string>

#include "relative_map/model/inputs.hpp"
#include "relative_map/pipeline/motion/course_check.hpp"

namespace relative_map::core {

/// What motion says of a direction that localization gives.
struct DirectionEvidence {
  CourseCheck::Verdict verdict = CourseCheck::Verdict::kUnknown;
  CourseCheck::Cause cause = CourseCheck::Cause::kNone;
  double latest_offset = 0.0;  ///< [rad] to the left of the course, in the last seconds; NaN: not known
  double steady_offset = 0.0;  ///< [rad] the same in the long run, as far as it is certain
};
struct MotionEvidence {
  DirectionEvidence heading, orientation;
};

/// How far apart poses lie by noise: white from pose to pose, of one coordinate [m].
class PositionNoise {
 public:
  /// By rising stamps.
  void add(Time stamp, const Point2& position);
  double stddev() const;

 private:
  std::optional<Time> last_, before_;
  Point2 last_position_, position_before_;
  double variance_ = 0.0;  ///< [m^2]
  int measured_ = 0;
};

/// The mean of the poses of a short while: noise averages out, and the way is not bent enough to matter.
class MeanPose {
 public:
  /// Whether `stamp` is still of that while.
  bool holds(Time stamp) const;
  void add(Time stamp, const Pose2& pose, const KnownMotion& motion);
  bool empty() const { return count_ == 0; }
  int count() const { return count_; }
  Time stamp() const { return begin_ + since_ / count_; }
  Pose2 pose() const { return {first_.position() + moved_ / count_, first_.heading() + turned_ / count_}; }
  const KnownMotion& motion() const { return motion_; }

 private:
  int count_ = 0;
  Time begin_{};
  Pose2 first_;
  KnownMotion motion_;  ///< of the last one
  Duration since_{};    ///< sums of what came after the first one
  Point2 moved_ = Point2::Zero();
  double turned_ = 0.0;
};

/// A moving vehicle's poses tell its course: the witness for or against pose.heading and pose.orientation,
/// each on its own.
class HeadingWitness {
 public:
  /// Of a link of the vehicle, after check_numbers, by rising stamps; directions that are not given are NaN,
  /// or an orientation of zeros. `heading_in_range`: false where a heading was given that is no angle in
  /// radians. `motion.position_noise` is measured here.
  void add(const Localization& link, const std::optional<Eigen::Isometry3d>& link_from_base,
           KnownMotion motion, bool heading_in_range = true);
  MotionEvidence evidence() const;
  void reset() { *this = HeadingWitness(); }

 private:
  struct Witness {
    MeanPose mean;
    CourseCheck check;

    void add(Time stamp, const Pose2& base, const KnownMotion& motion);
  };
  PositionNoise noise_;
  Witness heading_, orientation_;
  int out_of_range_ = 0;  ///< headings in a row
};

/// "it seems to be a compass heading, ..."; for `cause` of a direction of that name ("pose.heading").
std::string likely_cause(CourseCheck::Cause cause, bool of_orientation);

}  // namespace relative_map::core
